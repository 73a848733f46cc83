#include "capture/camera/camera_state.h"

#include "capture/base/status.h"

namespace eyebox::capture {
namespace {

absl::Status CheckLimits(const std::string& where, double value, double minimum, double maximum) {
  if (value >= minimum && value <= maximum) return absl::OkStatus();
  return BadInput(
      where, "is " + std::to_string(value),
      "this camera takes " + std::to_string(minimum) + " to " + std::to_string(maximum));
}

}  // namespace

absl::Status CheckSettings(const CameraInfo& info, const CameraSettings& settings) {
  EYEBOX_RETURN_IF_ERROR(CheckLimits(info.uri + " exposure_s", settings.exposure_s,
                                     info.exposure_min_s, info.exposure_max_s));
  return CheckLimits(info.uri + " gain_db", settings.gain_db, info.gain_min_db, info.gain_max_db);
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
