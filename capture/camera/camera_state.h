// The rules that every camera follows, whatever makes its frames: which call is allowed when, and
// which settings.
#ifndef EYEBOX_CAPTURE_CAMERA_CAMERA_STATE_H_
#define EYEBOX_CAPTURE_CAMERA_CAMERA_STATE_H_

#include <string>

#include "absl/status/status.h"
#include "capture/camera/camera.h"

namespace eyebox::capture {

// Errors: InvalidArgument (outside the limits of `info`; names the field and the limits).
absl::Status CheckSettings(const CameraInfo& info, const CameraSettings& settings);

// The state of a software-triggered camera. Each call checks whether the camera may do it and
// notes that it did; the errors are those of Camera.
class CameraState {
 public:
  explicit CameraState(std::string uri) : uri_(std::move(uri)) {}

  absl::Status Configure(const CameraInfo& info, const CameraSettings& settings);
  absl::Status Start();
  absl::Status Trigger();
  // Takes one pending exposure. Errors: FailedPrecondition (not started), DeadlineExceeded (no
  // exposure is pending, so that waiting would be in vain).
  absl::Status TakePending();
  void Stop();

  const CameraSettings& settings() const { return settings_; }

 private:
  std::string uri_;
  CameraSettings settings_;
  bool configured_ = false;
  bool running_ = false;
  int pending_ = 0;
};

}  // namespace eyebox::capture

#endif  // EYEBOX_CAPTURE_CAMERA_CAMERA_STATE_H_
