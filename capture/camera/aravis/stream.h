// Buffers on their way between camera and Frame.
#ifndef EYEBOX_CAPTURE_CAMERA_ARAVIS_STREAM_H_
#define EYEBOX_CAPTURE_CAMERA_ARAVIS_STREAM_H_

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "absl/status/statusor.h"
#include "capture/base/clock.h"
#include "capture/base/frame.h"
#include "capture/camera/aravis/device.h"

namespace eyebox::capture::aravis {

// One buffer that the transport is done with.
struct Arrival {
  BufferStatus status = BufferStatus::kComplete;
  uint64_t device_id = 0;  // as on the wire, may wrap
  uint32_t missing_packets = 0;
  std::optional<int64_t> device_time_ns;
  int64_t monotonic_time_ns = 0;
  uint32_t pfnc = 0;
  ImageSize size;
  size_t padding_bytes = 0;           // at the end of each row
  std::span<const std::byte> bytes;   // empty unless complete
  std::shared_ptr<const void> owner;  // gives the buffer back when its last copy is gone
};

// Buffers of one size. They outlive camera and stream for as long as a Frame holds one.
class BufferPool;
std::shared_ptr<BufferPool> MakeBufferPool(int count, size_t bytes);

// One acquisition. A new stream has a new port, so that no frame of the one before can arrive.
// One thread, the one that uses the device.
class Stream {
 public:
  // Errors: Unavailable.
  static absl::StatusOr<std::unique_ptr<Stream>> Open(Device& device, const AravisOptions& options,
                                                      std::shared_ptr<BufferPool> pool,
                                                      const Clock* clock);
  ~Stream();

  // Hands the camera every buffer that is free, or one. Returns how many it got.
  int OfferAll();
  int OfferOne();
  // How many buffers wait for the camera to fill them.
  int Waiting() const;

  // The next buffer, in the order in which they were finished; empty after `timeout`.
  std::optional<Arrival> Pop(std::chrono::microseconds timeout);

 private:
  struct Impl;
  explicit Stream(std::unique_ptr<Impl> impl);
  const std::unique_ptr<Impl> impl_;
};

}  // namespace eyebox::capture::aravis

#endif  // EYEBOX_CAPTURE_CAMERA_ARAVIS_STREAM_H_
