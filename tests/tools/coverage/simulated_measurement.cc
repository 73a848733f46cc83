#include "tests/tools/coverage/simulated_measurement.h"

#include <cstdlib>
#include <optional>
#include <utility>

#include "capture/base/status.h"
#include "capture/camera/sim/scene.h"
#include "optics/sensor/defect_map.h"
#include "optics/sensor/photon_transfer.h"

namespace eyebox {
namespace {

constexpr double kExposures_s[] = {0.0125, 0.075, 0.45};
constexpr int kDarkRepeats = 8;
constexpr int kFlatRepeats = 8;
constexpr double kFlatLuminance = 9;
constexpr double kFlatRelativeSigma = 0.02;
constexpr uint64_t kNoiseStream = 77;

const optics::ReduceOptions kGrey{.colour_period_px = 1};

CaptureSpec Spec(FrameKind kind, int repeats) {
  CaptureSpec spec;
  spec.kind = kind;
  spec.repeats = repeats;
  return spec;
}

}  // namespace

capture::SimParameters SmallRig() {
  capture::SimParameters parameters;
  parameters.sensor.size = {.width_px = 96, .height_px = 96};
  parameters.geometry = {
      .focal_length_px = 572.9578, .principal_x_px = 47.5, .principal_y_px = 47.5};
  parameters.scatter = {.core_sigma_px = 0.6,
                        .tail_weight = 0.1,
                        .tail_scale_px = 6,
                        .tail_beta = 1.5,
                        .tail_radius_px = 80};
  return parameters;
}

SimulatedMeasurement::SimulatedMeasurement(const capture::SimParameters& parameters, uint64_t seed)
    : parameters_(parameters),
      pattern_(capture::MakeFixedPattern(parameters.sensor, seed)),
      noise_({seed, kNoiseStream}) {
  flat_factor_ = 1 + kFlatRelativeSigma * noise_.Gaussian();
}

absl::StatusOr<std::vector<optics::Stack>> SimulatedMeasurement::Bracket(
    const CaptureSpec& spec, std::vector<std::vector<uint16_t>>* frames) {
  EYEBOX_ASSIGN_OR_RETURN(const Image<double> rate,
                          capture::SceneRate(parameters_, pattern_, spec));
  std::vector<optics::Stack> stacks;
  for (const double exposure_s : kExposures_s) {
    optics::FrameStacker stacker({exposure_s, 0}, {.bits = parameters_.sensor.bits});
    for (int k = 0; k < spec.repeats; ++k) {
      std::vector<uint16_t> counts =
          capture::Expose(parameters_.sensor, pattern_, rate, {.exposure_s = exposure_s}, noise_);
      EYEBOX_RETURN_IF_ERROR(stacker.Add({counts, parameters_.sensor.size}));
      if (frames != nullptr) frames->push_back(std::move(counts));
    }
    EYEBOX_ASSIGN_OR_RETURN(optics::Stack stack, stacker.Finish());
    stacks.push_back(std::move(stack));
  }
  return stacks;
}

absl::Status SimulatedMeasurement::Calibrate() {
  std::vector<std::vector<uint16_t>> frames;
  EYEBOX_ASSIGN_OR_RETURN(const auto darks, Bracket(Spec(FrameKind::kDark, kDarkRepeats), &frames));
  EYEBOX_ASSIGN_OR_RETURN(calibration_.defects, optics::FindHotPixels(darks));
  CaptureSpec flat = Spec(FrameKind::kFlat, kFlatRepeats);
  flat.luminance_cd_m2 = kFlatLuminance * flat_factor_;
  EYEBOX_ASSIGN_OR_RETURN(const auto flats, Bracket(flat, &frames));
  optics::PhotonTransfer transfer(darks.front(), calibration_.defects.defective,
                                  {.colour_period_px = 1});
  const size_t dark_frames = std::size(kExposures_s) * kDarkRepeats;
  for (size_t i = 0; i < frames.size(); ++i) {
    static_assert(kDarkRepeats == kFlatRepeats);
    if (i % kDarkRepeats == 0) {
      transfer.BeginCapture(i < dark_frames ? FrameKind::kDark : FrameKind::kFlat);
    }
    EYEBOX_RETURN_IF_ERROR(transfer.AddFrame({frames[i], parameters_.sensor.size}));
  }
  EYEBOX_ASSIGN_OR_RETURN(calibration_.noise, transfer.Fit());
  for (const optics::Stack& dark : darks) {
    EYEBOX_ASSIGN_OR_RETURN(optics::DarkFrame frame, optics::MeasureDark(dark, calibration_.noise));
    calibration_.darks.push_back(std::move(frame));
  }
  EYEBOX_ASSIGN_OR_RETURN(
      calibration_.flat,
      optics::MeasureFlat(flats, calibration_,
                          optics::KnownLuminance{kFlatLuminance, kFlatRelativeSigma}, kGrey));
  return absl::OkStatus();
}

absl::StatusOr<optics::ReducedLevel> SimulatedMeasurement::Measure(const Stimulus& stimulus,
                                                                   int repeats) {
  CaptureSpec spec = Spec(FrameKind::kLight, repeats);
  spec.stimulus = stimulus;
  EYEBOX_ASSIGN_OR_RETURN(const auto stacks, Bracket(spec, nullptr));
  return optics::ReduceLevel(stacks, calibration_, kGrey);
}

Image<double> SimulatedMeasurement::Truth(const Stimulus& stimulus) const {
  CaptureSpec light = Spec(FrameKind::kLight, 1);
  light.stimulus = stimulus;
  CaptureSpec flat = Spec(FrameKind::kFlat, 1);
  flat.luminance_cd_m2 = 1;
  auto truth = capture::SceneRate(parameters_, pattern_, light);
  const auto unit = capture::SceneRate(parameters_, pattern_, flat);
  if (!truth.ok() || !unit.ok()) std::abort();  // stimuli of the tool itself
  for (size_t i = 0; i < truth->pixels().size(); ++i) truth->pixels()[i] /= unit->pixels()[i];
  return *std::move(truth);
}

}  // namespace eyebox
