#include "service/planner/simulated_measurement.h"

#include <bit>
#include <utility>

#include "capture/base/status.h"
#include "capture/camera/sim/display.h"
#include "capture/camera/sim/scene.h"
#include "optics/sensor/defect_map.h"
#include "optics/sensor/photon_transfer.h"
#include "service/steps/reference_disk.h"

namespace eyebox::service {
namespace {

constexpr double kFlatLuminance = 9;
constexpr double kFlatRelativeSigma = 0.02;
constexpr uint64_t kFlatStream = 77;
constexpr uint64_t kFrameStream = 78;

const optics::ReduceOptions kGrey{.colour_period_px = 1};

CaptureSpec DarkSpec() {
  CaptureSpec spec;
  spec.kind = FrameKind::kDark;
  return spec;
}

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

std::vector<uint64_t> KeyOf(const CaptureSpec& spec) {
  const DriveRgb drive = spec.stimulus.drive.value_or(DriveRgb{});
  return {static_cast<uint64_t>(spec.kind),
          static_cast<uint64_t>(spec.stimulus.pattern),
          std::bit_cast<uint64_t>(spec.stimulus.diameter_deg),
          std::bit_cast<uint64_t>(drive[0]),
          std::bit_cast<uint64_t>(drive[1]),
          std::bit_cast<uint64_t>(drive[2])};
}

uint64_t Mixed(const std::vector<uint64_t>& key) {
  uint64_t mixed = 0;
  for (const uint64_t part : key) mixed = (mixed ^ part) * 0x9e3779b97f4a7c15U + (mixed >> 29);
  return mixed;
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
  const std::vector<uint64_t> key = KeyOf(spec);
  const auto known = shown_.find(key);
  if (known != shown_.end()) return &known->second;
  EYEBOX_ASSIGN_OR_RETURN(Image<double> rate, capture::SceneRate(parameters_, pattern_, spec));
  Shown shown{spec, std::move(rate), std::vector<Frames>(options_.exposures_s.size()), {}};
  for (uint64_t k = 0; k < options_.exposures_s.size(); ++k) {
    shown.noises.emplace_back(std::initializer_list<uint64_t>{seed_, kFrameStream, Mixed(key), k});
  }
  return &shown_.emplace(key, std::move(shown)).first->second;
}

const SimulatedMeasurement::Frames& SimulatedMeasurement::Exposed(Shown& shown, size_t exposure,
                                                                  int frames) {
  Frames& taken = shown.frames[exposure];
  while (taken.size() < static_cast<size_t>(frames)) {
    taken.push_back(capture::Expose(parameters_.sensor, pattern_, shown.rate_e_s,
                                    {.exposure_s = options_.exposures_s[exposure]},
                                    shown.noises[exposure]));
  }
  return taken;
}

absl::StatusOr<optics::Stack> SimulatedMeasurement::StackOf(Shown& shown, size_t exposure,
                                                            int frames) {
  optics::FrameStacker stacker({options_.exposures_s[exposure], 0},
                               {.bits = parameters_.sensor.bits});
  const Frames& taken = Exposed(shown, exposure, frames);
  for (int k = 0; k < frames; ++k) {
    EYEBOX_RETURN_IF_ERROR(stacker.Add({taken[static_cast<size_t>(k)], parameters_.sensor.size}));
  }
  return stacker.Finish();
}

absl::StatusOr<std::vector<optics::Stack>> SimulatedMeasurement::Bracket(
    const CaptureSpec& spec, const std::vector<int>& frames) {
  EYEBOX_ASSIGN_OR_RETURN(Shown* const shown, Show(spec));
  std::vector<optics::Stack> stacks;
  for (size_t k = 0; k < frames.size(); ++k) {
    if (frames[k] == 0) continue;
    EYEBOX_ASSIGN_OR_RETURN(optics::Stack stack, StackOf(*shown, k, frames[k]));
    stacks.push_back(std::move(stack));
  }
  return stacks;
}

absl::StatusOr<std::vector<optics::Stack>> SimulatedMeasurement::Take(
    const Stimulus& stimulus, const std::vector<int>& frames) {
  return Bracket(LightSpec(stimulus), frames);
}

absl::StatusOr<optics::NoiseModel> SimulatedMeasurement::MeasureNoise(
    const optics::Stack& shortest_dark, int frames, const optics::DefectMap& defects) {
  optics::PhotonTransfer transfer(shortest_dark, defects.defective, {.colour_period_px = 1});
  for (const CaptureSpec& spec : {DarkSpec(), FlatSpec(kFlatLuminance * flat_factor_)}) {
    EYEBOX_ASSIGN_OR_RETURN(Shown* const shown, Show(spec));
    for (size_t k = 0; k < options_.exposures_s.size(); ++k) {
      transfer.BeginCapture(spec.kind);
      const Frames& taken = Exposed(*shown, k, frames);
      for (int i = 0; i < frames; ++i) {
        EYEBOX_RETURN_IF_ERROR(
            transfer.AddFrame({taken[static_cast<size_t>(i)], parameters_.sensor.size}));
      }
    }
  }
  return transfer.Fit();
}

absl::StatusOr<optics::Calibration> SimulatedMeasurement::Calibrate(int frames) {
  optics::Calibration calibration;
  const std::vector<int> all(options_.exposures_s.size(), frames);
  EYEBOX_ASSIGN_OR_RETURN(const auto darks, Bracket(DarkSpec(), all));
  EYEBOX_ASSIGN_OR_RETURN(calibration.defects, optics::FindHotPixels(darks));
  EYEBOX_ASSIGN_OR_RETURN(calibration.noise,
                          MeasureNoise(darks.front(), frames, calibration.defects));
  for (const optics::Stack& dark : darks) {
    EYEBOX_ASSIGN_OR_RETURN(optics::DarkFrame frame, optics::MeasureDark(dark, calibration.noise));
    calibration.darks.push_back(std::move(frame));
  }
  EYEBOX_ASSIGN_OR_RETURN(const auto flats, Bracket(FlatSpec(kFlatLuminance * flat_factor_), all));
  EYEBOX_ASSIGN_OR_RETURN(
      calibration.flat,
      optics::MeasureFlat(flats, calibration,
                          optics::KnownLuminance{kFlatLuminance, kFlatRelativeSigma}, kGrey));
  return calibration;
}

absl::StatusOr<const optics::Calibration*> SimulatedMeasurement::CalibrationOf(int frames) {
  const auto known = calibrations_.find(frames);
  if (known != calibrations_.end()) return &known->second;
  EYEBOX_ASSIGN_OR_RETURN(optics::Calibration calibration, Calibrate(frames));
  return &calibrations_.emplace(frames, std::move(calibration)).first->second;
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
