// The photodiode during one capture: its samples and the clocks go where the frames go.
#ifndef EYEBOX_CAPTURE_RUN_SAMPLE_LOG_H_
#define EYEBOX_CAPTURE_RUN_SAMPLE_LOG_H_

#include <chrono>
#include <cstdint>

#include "absl/status/status.h"
#include "capture/camera/rig.h"
#include "capture/recording/writer.h"
#include "capture/run.h"

namespace eyebox::capture {

// A rig without a photodiode has clock triples alone. Errors of all functions: Aborted (the
// photodiode failed, named: take the capture again), those of the writer and of the clocks.
class SampleLog {
 public:
  // Both must outlive it.
  SampleLog(Rig& rig, const RunOptions& options) : rig_(rig), options_(options) {}

  // Stops what an attempt before left running, and sets the rate.
  absl::Status Prepare();
  // As long as captures before took, with a margin; of a first one, as long as may be expected.
  SideRoom RoomFor(const CaptureSpec& spec) const;
  // Before the first trigger.
  absl::Status Begin(CaptureWriter& capture);
  // Takes what is there. Waits for nothing, so that no frame is late for it.
  absl::Status Drain(CaptureWriter& capture);
  // Takes the samples up to `last_frame_ns` (CLOCK_MONOTONIC), and stops. Before the last sync.
  absl::Status Finish(const CaptureSpec& spec, int64_t last_frame_ns, CaptureWriter& capture);

  int64_t samples() const { return samples_; }  // of this capture, those without room included

 private:
  absl::Status Read(std::chrono::milliseconds timeout, CaptureWriter& capture);
  absl::Status AppendTriple(CaptureWriter& capture);
  absl::Status Failed(const absl::Status& status) const;
  void NoteDuration(const CaptureSpec& spec, int64_t end_ns);

  Rig& rig_;
  const RunOptions& options_;
  double rate_hz_ = 0;            // read back; 0 without a photodiode
  double beyond_exposure_s_ = 0;  // longest seen, for a frame
  int64_t begun_ns_ = 0;
  int64_t last_sample_ns_ = 0;
  int64_t samples_ = 0;
  bool waiting_ = false;        // more samples may come
  bool pulse_started_ = false;  // one conversion a frame
};

}  // namespace eyebox::capture

#endif  // EYEBOX_CAPTURE_RUN_SAMPLE_LOG_H_
