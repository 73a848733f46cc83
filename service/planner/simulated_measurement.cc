#include "service/planner/simulated_measurement.h"

#include <utility>

#include "capture/base/status.h"
#include "capture/camera/sim/display.h"
#include "capture/camera/sim/scene.h"
#include "service/steps/reference_disk.h"

namespace eyebox::service {
namespace {

constexpr double kFlatLuminance = 9;
constexpr double kFlatRelativeSigma = 0.02;
constexpr uint64_t kFlatStream = 77;
constexpr uint64_t kFrameStream = 78;

const optics::ReduceOptions kGrey{.colour_period_px = 1};

CaptureSpec FlatSpec(double luminance_cd_m2) {
  CaptureSpec spec;
  spec.kind = FrameKind::kFlat;
  spec.luminance_cd_m2 = luminance_cd_m2;
  return spec;
}

CaptureSpec LightSpec(const Stimulus& stimulus) {
  CaptureSpec spec;
  spec.stimulus = stimulus;
  return spec;
}

Stimulus White() {
  Stimulus white;
  white.drive = DriveRgb{1, 1, 1};
  return white;
}

double MeanOver(const std::vector<size_t>& pixels, const Image<double>& image) {
  double sum = 0;
  for (const size_t i : pixels) sum += image.pixels()[i];
  return sum / static_cast<double>(pixels.size());
}

}  // namespace

SimulatedMeasurement::SimulatedMeasurement(const capture::SimParameters& parameters, uint64_t seed,
                                           const SimulatedMeasurementOptions& options)
    : parameters_(parameters),
      seed_(seed),
      options_(options),
      pattern_(capture::MakeFixedPattern(parameters.sensor, seed)) {
  flat_factor_ = 1 + kFlatRelativeSigma * capture::NoiseSource({seed, kFlatStream}).Gaussian();
}

absl::StatusOr<SimulatedMeasurement::Shown*> SimulatedMeasurement::Show(const CaptureSpec& spec) {
  const std::vector<uint64_t> key = SceneKeyOf(spec);
  const auto known = shown_.find(key);
  if (known != shown_.end()) return &known->second;
  EYEBOX_ASSIGN_OR_RETURN(Image<double> rate, capture::SceneRate(parameters_, pattern_, spec));
  Shown shown{spec, std::move(rate), {}, {}};
  shown.frames.resize(options_.exposures_s.size());
  for (uint64_t k = 0; k < options_.exposures_s.size(); ++k) {
    shown.noises.emplace_back(
        std::initializer_list<uint64_t>{seed_, kFrameStream, MixedKey(key), k});
  }
  return &shown_.emplace(key, std::move(shown)).first->second;
}

absl::StatusOr<std::vector<HeldFrames::Counts>> SimulatedMeasurement::FramesOf(
    const CaptureSpec& scene, size_t exposure, int count) {
  EYEBOX_ASSIGN_OR_RETURN(Shown* const shown, Show(scene));
  auto& taken = shown->frames[exposure];
  while (taken.size() < static_cast<size_t>(count)) {
    taken.push_back(capture::Expose(parameters_.sensor, pattern_, shown->rate_e_s,
                                    {.exposure_s = options_.exposures_s[exposure]},
                                    shown->noises[exposure]));
  }
  return std::vector<Counts>(taken.begin(), taken.begin() + count);
}

CaptureSpec SimulatedMeasurement::FlatScene() const {
  return FlatSpec(kFlatLuminance * flat_factor_);
}

optics::KnownLuminance SimulatedMeasurement::StatedFlat() const {
  return {kFlatLuminance, kFlatRelativeSigma};
}

absl::StatusOr<optics::ReducedLevel> SimulatedMeasurement::Measure(const Stimulus& stimulus,
                                                                   int repeats) {
  EYEBOX_ASSIGN_OR_RETURN(const auto* const calibration,
                          CalibrationOf(options_.calibration_frames));
  EYEBOX_ASSIGN_OR_RETURN(const auto stacks,
                          Take(stimulus, std::vector<int>(options_.exposures_s.size(), repeats)));
  return optics::ReduceLevel(stacks, *calibration, kGrey);
}

absl::StatusOr<Image<double>> SimulatedMeasurement::LuminanceOf(const Stimulus& stimulus) const {
  EYEBOX_ASSIGN_OR_RETURN(Image<double> light,
                          capture::SceneRate(parameters_, pattern_, LightSpec(stimulus)));
  EYEBOX_ASSIGN_OR_RETURN(const Image<double> unit,
                          capture::SceneRate(parameters_, pattern_, FlatSpec(1)));
  for (size_t i = 0; i < light.pixels().size(); ++i) light.pixels()[i] /= unit.pixels()[i];
  return light;
}

absl::StatusOr<Truth> SimulatedMeasurement::TruthFor(double disk_deg) {
  Truth truth;
  EYEBOX_ASSIGN_OR_RETURN(truth.white, LuminanceOf(White()));
  truth.relative_luminance = [display = parameters_.display](const DriveRgb& drive) {
    return capture::DisplayLuminance(display, drive) /
           capture::DisplayLuminance(display, {1, 1, 1});
  };
  truth.stated_over_true = scale_error();
  if (disk_deg == 0) return truth;
  Stimulus disk = White();
  disk.pattern = StimulusPattern::kDisk;
  disk.diameter_deg = disk_deg;
  EYEBOX_ASSIGN_OR_RETURN(const Image<double> amid, LuminanceOf(disk));
  const std::vector<size_t> middle = ReferenceDiskPixels(Size());
  truth.glare_factor = MeanOver(middle, amid) / MeanOver(middle, truth.white);
  return truth;
}

}  // namespace eyebox::service
