#include "capture/recording/rolling.h"

#include "capture/base/status.h"

namespace eyebox::capture {

absl::Status RollingCapture::Append(const Frame& frame) {
  if (options_.frames_per_acknowledgement < 1) {
    return BadInput("RollingOptions.frames_per_acknowledgement", "is below 1", "give one or more");
  }
  if (!capture_) {
    EYEBOX_ASSIGN_OR_RETURN(capture_, writer_.BeginCapture(options_.spec, options_.frame_size));
    in_capture_ = 0;
  }
  EYEBOX_RETURN_IF_ERROR(capture_->Append(frame));
  ++appended_;
  ++in_capture_;
  const bool full = in_capture_ == options_.spec.repeats;
  if (full || appended_ - acknowledged_ >= options_.frames_per_acknowledgement) {
    EYEBOX_RETURN_IF_ERROR(Acknowledge());
  }
  if (!full) return absl::OkStatus();
  const std::unique_ptr<CaptureWriter> complete = std::move(capture_);
  return complete->Publish();
}

absl::Status RollingCapture::Finish() {
  if (!capture_ || in_capture_ == 0) return absl::OkStatus();
  EYEBOX_RETURN_IF_ERROR(Acknowledge());
  const std::unique_ptr<CaptureWriter> last = std::move(capture_);
  return last->PublishEarly();
}

absl::Status RollingCapture::Acknowledge() {
  EYEBOX_RETURN_IF_ERROR(capture_->Acknowledge());
  acknowledged_ = appended_;
  return absl::OkStatus();
}

}  // namespace eyebox::capture
