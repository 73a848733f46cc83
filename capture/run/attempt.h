// One attempt at one capture: its frames are on stable storage, and nothing is published.
#ifndef EYEBOX_CAPTURE_RUN_ATTEMPT_H_
#define EYEBOX_CAPTURE_RUN_ATTEMPT_H_

#include <cstdint>
#include <memory>
#include <optional>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "capture/camera/rig.h"
#include "capture/recording/writer.h"
#include "capture/run.h"
#include "capture/run/frame_mean.h"
#include "capture/run/sample_log.h"
#include "capture/run/settle.h"

namespace eyebox::capture {

// What every capture of a run sets alike: all but exposure and gain.
CameraSettings StateOf(const Rig& rig);

struct TakenCapture {
  std::unique_ptr<CaptureWriter> writer;  // every frame acknowledged
  FrameMean mean;
  std::optional<Settling> settling;
  int64_t samples = 0;  // of the photodiode
};

class CaptureTaker {
 public:
  // All must outlive it. The rig's camera may be replaced between attempts.
  CaptureTaker(Rig& rig, RecordingWriter& writer, const RunOptions& options)
      : rig_(rig), writer_(writer), options_(options), samples_(rig, options) {}

  // Errors: Aborted (spoilt, try again); see camera_lost() for Unavailable; those of RunPlan().
  absl::StatusOr<TakenCapture> Attempt(const CaptureSpec& spec);

  // The last attempt failed because the camera did not answer.
  bool camera_lost() const { return camera_lost_; }
  void CameraIsBack() { camera_lost_ = false; }

  // The next attempt waits for the scene although it was there before.
  void SettleAnew() { settled_on_.reset(); }

 private:
  absl::Status Configure(const CaptureSpec& spec);
  absl::StatusOr<std::optional<Settling>> Settle(const CaptureSpec& spec);
  absl::StatusOr<FrameMean> TakeFrames(const CaptureSpec& spec, CaptureWriter& capture);
  absl::StatusOr<Frame> TakeFrame(const CaptureSpec& spec);
  // CLOCK_MONOTONIC of the pulse that started it; nothing where software did.
  absl::StatusOr<std::optional<int64_t>> StartExposure();
  absl::Status FromCamera(absl::Status status);
  bool IsSettledOn(const CaptureSpec& spec) const;

  Rig& rig_;
  RecordingWriter& writer_;
  const RunOptions& options_;
  SampleLog samples_;
  bool camera_lost_ = false;
  std::optional<CaptureSpec> settled_on_;
};

}  // namespace eyebox::capture

#endif  // EYEBOX_CAPTURE_RUN_ATTEMPT_H_
