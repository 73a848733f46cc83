#include "capture/camera/camera_state.h"

#include <algorithm>

#include "capture/base/status.h"

namespace eyebox::capture {
namespace {

absl::Status CheckLimits(const std::string& where, double value, double minimum, double maximum) {
  if (value >= minimum && value <= maximum) return absl::OkStatus();
  return BadInput(
      where, "is " + std::to_string(value),
      "this camera takes " + std::to_string(minimum) + " to " + std::to_string(maximum));
}

absl::Status CheckTrigger(const CameraInfo& info, const CameraSettings& settings) {
  const std::string where = info.uri + " trigger";
  switch (settings.trigger) {
    case TriggerSource::kSoftware:
      if (info.software_trigger) return absl::OkStatus();
      return BadInput(where, "cannot come from software", "wire a trigger line or let it run free");
    case TriggerSource::kFreeRun:
      if (!info.free_run) return BadInput(where, "is needed for every frame", "do not run it free");
      if (settings.frame_rate_hz >= 0) return absl::OkStatus();
      return BadInput(info.uri + " frame_rate_hz", "is " + std::to_string(settings.frame_rate_hz),
                      "give 0 or a positive rate");
    case TriggerSource::kLine:
      break;
  }
  if (std::ranges::count(info.trigger_lines, settings.trigger_line) > 0) return absl::OkStatus();
  std::string lines;
  for (const std::string& line : info.trigger_lines) lines.append(" ").append(line);
  return BadInput(where + "_line", "is '" + settings.trigger_line + "'",
                  lines.empty() ? "this camera has no trigger line" : "name one of" + lines);
}

}  // namespace

absl::Status CheckSettings(const CameraInfo& info, const CameraSettings& settings) {
  EYEBOX_RETURN_IF_ERROR(CheckLimits(info.uri + " exposure_s", settings.exposure_s,
                                     info.exposure_min_s, info.exposure_max_s));
  EYEBOX_RETURN_IF_ERROR(
      CheckLimits(info.uri + " gain_db", settings.gain_db, info.gain_min_db, info.gain_max_db));
  if (settings.black_level) {
    EYEBOX_RETURN_IF_ERROR(CheckLimits(info.uri + " black_level", *settings.black_level,
                                       info.black_level_min, info.black_level_max));
  }
  return CheckTrigger(info, settings);
}

absl::Status CameraState::Configure(const CameraInfo& info, const CameraSettings& settings) {
  if (running_) return Rejected(uri_, "cannot be configured while it runs", "stop it first");
  EYEBOX_RETURN_IF_ERROR(CheckSettings(info, settings));
  settings_ = settings;
  configured_ = true;
  return absl::OkStatus();
}

absl::Status CameraState::Start() {
  if (running_) return Rejected(uri_, "runs already", "stop it first");
  if (!configured_) return Rejected(uri_, "was never configured", "configure it before starting");
  running_ = true;
  return absl::OkStatus();
}

absl::Status CameraState::Trigger() {
  if (!running_) return Rejected(uri_, "was triggered while stopped", "start it first");
  ++pending_;
  return absl::OkStatus();
}

absl::Status CameraState::TakePending() {
  if (!running_) return Rejected(uri_, "was asked for a frame while stopped", "start it first");
  if (pending_ == 0) {
    return absl::DeadlineExceededError(
        Complaint(uri_, "has no frame to deliver", "trigger it once for every frame"));
  }
  --pending_;
  return absl::OkStatus();
}

void CameraState::Stop() {
  running_ = false;
  pending_ = 0;
}

}  // namespace eyebox::capture
