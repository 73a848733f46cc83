#include "service/planner/held_frames.h"

#include <bit>
#include <utility>

#include "capture/base/status.h"
#include "optics/reduce/reduce_level.h"
#include "optics/sensor/defect_map.h"
#include "optics/sensor/photon_transfer.h"

namespace eyebox::service {
namespace {

const optics::ReduceOptions kGrey{.colour_period_px = 1};

}  // namespace

CaptureSpec DarkScene() {
  CaptureSpec scene;
  scene.kind = FrameKind::kDark;
  return scene;
}

std::vector<uint64_t> SceneKeyOf(const CaptureSpec& spec) {
  const DriveRgb drive = spec.stimulus.drive.value_or(DriveRgb{});
  return {static_cast<uint64_t>(spec.kind),
          static_cast<uint64_t>(spec.stimulus.pattern),
          std::bit_cast<uint64_t>(spec.stimulus.diameter_deg),
          std::bit_cast<uint64_t>(drive[0]),
          std::bit_cast<uint64_t>(drive[1]),
          std::bit_cast<uint64_t>(drive[2])};
}

uint64_t MixedKey(const std::vector<uint64_t>& key) {
  uint64_t mixed = 0;
  for (const uint64_t part : key) mixed = (mixed ^ part) * 0x9e3779b97f4a7c15U + (mixed >> 29);
  return mixed;
}

absl::StatusOr<std::vector<optics::Stack>> HeldFrames::Bracket(const CaptureSpec& scene,
                                                               const std::vector<int>& frames) {
  std::vector<optics::Stack> stacks;
  for (size_t k = 0; k < frames.size(); ++k) {
    if (frames[k] == 0) continue;
    EYEBOX_ASSIGN_OR_RETURN(const std::vector<Counts> taken, FramesOf(scene, k, frames[k]));
    optics::FrameStacker stacker({ExposuresS()[k], GainDb()}, {.bits = Bits()});
    for (const Counts& frame : taken) EYEBOX_RETURN_IF_ERROR(stacker.Add({frame, Size()}));
    EYEBOX_ASSIGN_OR_RETURN(optics::Stack stack, stacker.Finish());
    stacks.push_back(std::move(stack));
  }
  return stacks;
}

absl::StatusOr<std::vector<optics::Stack>> HeldFrames::Take(const Stimulus& stimulus,
                                                            const std::vector<int>& frames) {
  CaptureSpec scene;
  scene.stimulus = stimulus;
  return Bracket(scene, frames);
}

absl::StatusOr<optics::NoiseModel> HeldFrames::MeasureNoise(const optics::Stack& shortest_dark,
                                                            int frames,
                                                            const optics::DefectMap& defects) {
  optics::PhotonTransfer transfer(shortest_dark, defects.defective, {.colour_period_px = 1});
  for (const CaptureSpec& scene : {DarkScene(), FlatScene()}) {
    for (size_t k = 0; k < ExposuresS().size(); ++k) {
      EYEBOX_ASSIGN_OR_RETURN(const std::vector<Counts> taken, FramesOf(scene, k, frames));
      transfer.BeginCapture(scene.kind);
      for (const Counts& frame : taken) EYEBOX_RETURN_IF_ERROR(transfer.AddFrame({frame, Size()}));
    }
  }
  return transfer.Fit();
}

absl::StatusOr<optics::Calibration> HeldFrames::Calibrate(int frames) {
  optics::Calibration calibration;
  const std::vector<int> all(ExposuresS().size(), frames);
  EYEBOX_ASSIGN_OR_RETURN(const auto darks, Bracket(DarkScene(), all));
  EYEBOX_ASSIGN_OR_RETURN(calibration.defects, optics::FindHotPixels(darks));
  EYEBOX_ASSIGN_OR_RETURN(calibration.noise,
                          MeasureNoise(darks.front(), frames, calibration.defects));
  for (const optics::Stack& dark : darks) {
    EYEBOX_ASSIGN_OR_RETURN(optics::DarkFrame frame, optics::MeasureDark(dark, calibration.noise));
    calibration.darks.push_back(std::move(frame));
  }
  EYEBOX_ASSIGN_OR_RETURN(const auto flats, Bracket(FlatScene(), all));
  EYEBOX_ASSIGN_OR_RETURN(calibration.flat,
                          optics::MeasureFlat(flats, calibration, StatedFlat(), kGrey));
  return calibration;
}

absl::StatusOr<const optics::Calibration*> HeldFrames::CalibrationOf(int frames) {
  const auto known = calibrations_.find(frames);
  if (known != calibrations_.end()) return &known->second;
  EYEBOX_ASSIGN_OR_RETURN(optics::Calibration calibration, Calibrate(frames));
  return &calibrations_.emplace(frames, std::move(calibration)).first->second;
}

}  // namespace eyebox::service
