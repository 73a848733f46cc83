// For rigs with hardware: whoever runs the headset puts the stimulus there.
#ifndef EYEBOX_CAPTURE_CAMERA_MANUAL_PRESENTER_H_
#define EYEBOX_CAPTURE_CAMERA_MANUAL_PRESENTER_H_

#include "absl/status/status.h"
#include "capture/camera/rig.h"

namespace eyebox::capture {

class ManualPresenter final : public StimulusPresenter {
 public:
  absl::Status Present(const CaptureSpec&) override { return absl::OkStatus(); }
};

}  // namespace eyebox::capture

#endif  // EYEBOX_CAPTURE_CAMERA_MANUAL_PRESENTER_H_
