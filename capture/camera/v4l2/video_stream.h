// A ring of buffers that the driver fills and we map: V4L2 streaming I/O with MMAP.
#ifndef EYEBOX_CAPTURE_CAMERA_V4L2_VIDEO_STREAM_H_
#define EYEBOX_CAPTURE_CAMERA_V4L2_VIDEO_STREAM_H_

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "capture/camera/v4l2/video_node.h"

namespace eyebox::capture {

struct VideoBuffer {
  uint32_t index = 0;
  std::span<const std::byte> bytes;  // filled part; ours until Requeue()
  uint32_t sequence = 0;             // frames of the device, also those that never arrived
  int64_t time_ns = 0;               // CLOCK_MONOTONIC
  bool time_is_start = false;        // of the exposure; else of the end of the frame
  bool error = false;                // the driver says that the bytes are spoilt
};

enum class StreamEvent { kBuffer, kControl, kNothing };

// Not thread-safe. Streams from Start() to its end.
class VideoStream {
 public:
  // `node` must outlive the stream, its format must be set.
  // Errors: ResourceExhausted (another program streams, no memory), Unavailable.
  static absl::StatusOr<std::unique_ptr<VideoStream>> Start(const VideoNode& node, int buffers);
  ~VideoStream();
  VideoStream(const VideoStream&) = delete;
  VideoStream& operator=(const VideoStream&) = delete;

  // Empty: none is filled. Errors: Unavailable (unplugged, stopped by a fault, time stamps that are
  // not CLOCK_MONOTONIC).
  absl::StatusOr<std::optional<VideoBuffer>> Dequeue();
  absl::Status Requeue(uint32_t index);
  // Waits until a buffer is filled or a watched control changed. Errors: Unavailable.
  absl::StatusOr<StreamEvent> Wait(std::chrono::milliseconds timeout);

 private:
  struct Mapping {
    void* address = nullptr;
    size_t bytes = 0;
  };

  explicit VideoStream(const VideoNode& node) : node_(node) {}
  absl::Status Allocate(int buffers);
  absl::Status Map(uint32_t index);

  const VideoNode& node_;
  std::vector<Mapping> ring_;
  bool streaming_ = false;
};

}  // namespace eyebox::capture

#endif  // EYEBOX_CAPTURE_CAMERA_V4L2_VIDEO_STREAM_H_
