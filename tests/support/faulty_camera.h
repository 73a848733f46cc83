// A camera that misbehaves on demand: faults enter through the interface, as from a real one.
#ifndef EYEBOX_TESTS_SUPPORT_FAULTY_CAMERA_H_
#define EYEBOX_TESTS_SUPPORT_FAULTY_CAMERA_H_

#include <functional>
#include <memory>
#include <optional>
#include <utility>

#include "capture/camera/camera.h"

namespace eyebox::capture {

enum class CameraFault {
  kNone,
  kDropped,      // the frame is lost on the way and the next one comes instead
  kIncomplete,   // some packets are missing
  kTimedOut,     // the frame never comes
  kLate,         // the frame comes after it was given up
  kDuplicated,   // the frame before comes again instead
  kReordered,    // the next frame comes before this one
  kOldExposure,  // the frame reports an exposure of before
  kOtherGain,    // the frame reports another gain
  kLost,         // the camera is gone
};

// Passes everything on to `camera`; `fault(n)` says what happens to the n-th frame since opening.
class FaultyCamera final : public Camera {
 public:
  using FaultOf = std::function<CameraFault(int)>;
  FaultyCamera(std::unique_ptr<Camera> camera, FaultOf fault)
      : camera_(std::move(camera)), fault_(std::move(fault)) {}

  const CameraInfo& Info() const override { return camera_->Info(); }
  absl::StatusOr<CameraSettings> Configure(const CameraSettings& settings) override {
    return camera_->Configure(settings);
  }
  absl::Status Start() override { return camera_->Start(); }
  absl::Status Trigger() override { return camera_->Trigger(); }
  absl::Status Stop() override {
    held_back_.reset();
    return camera_->Stop();
  }

  absl::StatusOr<Frame> NextFrame(std::chrono::milliseconds timeout) override {
    const CameraFault fault = fault_(count_++);
    if (fault == CameraFault::kLate) return absl::DeadlineExceededError("no frame yet");
    if (held_back_) return *std::exchange(held_back_, std::nullopt);
    absl::StatusOr<Frame> frame = camera_->NextFrame(timeout);
    if (!frame.ok()) return frame;
    if (fault == CameraFault::kDuplicated && previous_) return *previous_;
    previous_ = *frame;
    FrameMetadata& metadata = frame->metadata;
    switch (fault) {
      case CameraFault::kNone:
        break;
      case CameraFault::kDropped:
        if (absl::Status status = camera_->Trigger(); !status.ok()) return status;
        return camera_->NextFrame(timeout);
      case CameraFault::kIncomplete:
        metadata.status = BufferStatus::kMissingPackets;
        metadata.missing_packets = 3;
        break;
      case CameraFault::kReordered:
        if (absl::Status status = camera_->Trigger(); !status.ok()) return status;
        held_back_ = *std::move(frame);
        return camera_->NextFrame(timeout);
      case CameraFault::kLate:
      case CameraFault::kDuplicated:
        break;
      case CameraFault::kTimedOut:
        return absl::DeadlineExceededError("no frame");
      case CameraFault::kOldExposure:
        metadata.exposure_reported_s = 1.5 * metadata.exposure_asked_s;
        break;
      case CameraFault::kOtherGain:
        metadata.gain_reported_db = metadata.gain_asked_db + 6;
        break;
      case CameraFault::kLost:
        return absl::UnavailableError("the camera is gone");
    }
    return frame;
  }

 private:
  const std::unique_ptr<Camera> camera_;
  const FaultOf fault_;
  int count_ = 0;
  std::optional<Frame> previous_;
  std::optional<Frame> held_back_;
};

}  // namespace eyebox::capture

#endif  // EYEBOX_TESTS_SUPPORT_FAULTY_CAMERA_H_
