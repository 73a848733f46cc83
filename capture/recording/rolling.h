// A recording of unknown length: captures of equal length one after another, the last one shorter.
#ifndef EYEBOX_CAPTURE_RECORDING_ROLLING_H_
#define EYEBOX_CAPTURE_RECORDING_ROLLING_H_

#include <cstdint>
#include <memory>
#include <utility>

#include "absl/status/status.h"
#include "capture/base/capture_spec.h"
#include "capture/recording/writer.h"

namespace eyebox::capture {

struct RollingOptions {
  CaptureSpec spec;  // repeats is the length of a capture: space for it is taken ahead
  ImageSize frame_size;
  int frames_per_acknowledgement = 16;
};

// Not thread-safe. `writer` must outlive it.
class RollingCapture {
 public:
  RollingCapture(RecordingWriter& writer, RollingOptions options)
      : writer_(writer), options_(std::move(options)) {}

  // Begins, acknowledges and publishes captures as they become due.
  // Errors: those of RecordingWriter and CaptureWriter; InvalidArgument
  // (frames_per_acknowledgement below 1). After one, nothing more may be appended.
  absl::Status Append(const Frame& frame);
  // Acknowledges and publishes what the last capture holds.
  absl::Status Finish();

  int64_t frames_acknowledged() const { return acknowledged_; }

 private:
  absl::Status Acknowledge();

  RecordingWriter& writer_;
  const RollingOptions options_;
  std::unique_ptr<CaptureWriter> capture_;
  int in_capture_ = 0;
  int64_t appended_ = 0;
  int64_t acknowledged_ = 0;
};

}  // namespace eyebox::capture

#endif  // EYEBOX_CAPTURE_RECORDING_ROLLING_H_
