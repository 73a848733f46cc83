// One frame as a camera delivered it: raw counts and what is known of how they came about.
#ifndef EYEBOX_CAPTURE_BASE_FRAME_H_
#define EYEBOX_CAPTURE_BASE_FRAME_H_

#include <cstdint>
#include <memory>
#include <optional>

#include "capture/base/image.h"

namespace eyebox {

// What the transport said of the buffer. Only kComplete is data.
enum class BufferStatus : uint8_t {
  kComplete = 0,
  kMissingPackets = 1,
  kTimedOut = 2,
  kDeviceError = 3,
  kAborted = 4,
};

// What was asked of the camera, and what it reported for this very frame where it does.
// An empty optional means that the device does not tell; it is never guessed.
struct FrameMetadata {
  BufferStatus status = BufferStatus::kComplete;
  uint64_t camera_frame_id = 0;  // as the device counts; a gap is a drop
  uint32_t missing_packets = 0;
  std::optional<int64_t> device_time_ns;   // the camera's own clock
  int64_t monotonic_time_ns = 0;           // CLOCK_MONOTONIC at reception
  std::optional<int64_t> trigger_time_ns;  // CLOCK_MONOTONIC of the trigger that caused it
  double exposure_asked_s = 0;
  std::optional<double> exposure_reported_s;
  double gain_asked_db = 0;
  std::optional<double> gain_reported_db;
  std::optional<double> black_level_dn;
  std::optional<double> temperature_degC;
  std::optional<double> photodiode_counts;  // of the reference photodiode, during the exposure
};

// Pixels and metadata travel as one. Copying a Frame shares the pixels; the buffer goes back to
// its camera's pool when the last copy is gone.
struct Frame {
  FrameMetadata metadata;
  FrameView view;
  std::shared_ptr<const void> owner;  // keeps view.pixels_dn alive
};

}  // namespace eyebox

#endif  // EYEBOX_CAPTURE_BASE_FRAME_H_
