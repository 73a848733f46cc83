#include "service/steps/calibrate.h"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "capture/base/status.h"
#include "optics/reduce/reduce_level.h"
#include "optics/sensor/photon_transfer.h"
#include "service/steps/captures.h"

namespace eyebox::service {
namespace {

absl::StatusOr<std::vector<optics::Stack>> StackDarks(capture::RecordingReader& recording) {
  const auto captures = CapturesOfKind(recording, FrameKind::kDark);
  if (captures.empty()) {
    return Rejected("recording", "it holds no dark frames",
                    "record darks of every exposure with the lens covered");
  }
  return StackCaptures(recording, captures);
}

absl::StatusOr<optics::NoiseModel> MeasureNoise(capture::RecordingReader& recording,
                                                const std::vector<optics::Stack>& darks,
                                                const optics::DefectMap& defects,
                                                const Watcher& watcher) {
  const auto shortest = std::min_element(darks.begin(), darks.end(), [](auto& a, auto& b) {
    return a.setting.exposure_s < b.setting.exposure_s;
  });
  optics::PhotonTransfer transfer(*shortest, defects.defective,
                                  {.colour_period_px = ColourPeriodPx(recording.Header())});
  const auto captures = recording.Captures();
  for (size_t i = 0; i < captures.size(); ++i) {
    EYEBOX_RETURN_IF_ERROR(
        watcher.Reach(static_cast<double>(i) / static_cast<double>(captures.size()),
                      "noise and gain from repeated frames"));
    transfer.BeginCapture(captures[i].spec.kind);
    EYEBOX_RETURN_IF_ERROR(recording.VisitFrames(
        captures[i], [&](const Frame& frame) { return transfer.AddFrame(frame.view); }));
  }
  return transfer.Fit();
}

std::optional<optics::KnownLuminance> LuminanceOf(const CaptureSpec& spec) {
  if (!spec.luminance_cd_m2) return std::nullopt;
  return optics::KnownLuminance{*spec.luminance_cd_m2, spec.luminance_relative_sigma.value_or(0)};
}

absl::StatusOr<std::optional<optics::FlatField>> MeasureFlatOf(
    capture::RecordingReader& recording, const optics::Calibration& calibration) {
  const auto captures = CapturesOfKind(recording, FrameKind::kFlat);
  if (captures.empty()) return std::nullopt;
  for (const capture::CaptureEntry* entry : captures) {
    if (entry->spec.luminance_cd_m2 != captures[0]->spec.luminance_cd_m2) {
      return Rejected(entry->file.string(), "its flat has another luminance than the first flat",
                      "record all flats at one luminance");
    }
  }
  EYEBOX_ASSIGN_OR_RETURN(const auto stacks, StackCaptures(recording, captures));
  EYEBOX_ASSIGN_OR_RETURN(
      optics::FlatField flat,
      optics::MeasureFlat(stacks, calibration, LuminanceOf(captures[0]->spec),
                          {.colour_period_px = ColourPeriodPx(recording.Header())}));
  return flat;
}

}  // namespace

absl::StatusOr<optics::Calibration> CalibrateCamera(capture::RecordingReader& recording,
                                                    const Watcher& watcher) {
  optics::Calibration calibration;
  EYEBOX_RETURN_IF_ERROR(watcher.Reach(0, "dark frames and hot pixels"));
  EYEBOX_ASSIGN_OR_RETURN(const std::vector<optics::Stack> darks, StackDarks(recording));
  EYEBOX_ASSIGN_OR_RETURN(calibration.defects, optics::FindHotPixels(darks));
  EYEBOX_ASSIGN_OR_RETURN(calibration.noise, MeasureNoise(recording, darks, calibration.defects,
                                                          watcher.Part(0.1, 0.9)));
  for (const optics::Stack& dark : darks) {
    EYEBOX_ASSIGN_OR_RETURN(optics::DarkFrame frame, optics::MeasureDark(dark, calibration.noise));
    calibration.darks.push_back(std::move(frame));
  }
  EYEBOX_RETURN_IF_ERROR(watcher.Reach(0.9, "flat field and luminance scale"));
  EYEBOX_ASSIGN_OR_RETURN(calibration.flat, MeasureFlatOf(recording, calibration));
  return calibration;
}

}  // namespace eyebox::service
