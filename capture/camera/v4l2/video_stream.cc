#include "capture/camera/v4l2/video_stream.h"

#include <errno.h>
#include <linux/videodev2.h>
#include <poll.h>

#include <algorithm>
#include <limits>

#include "capture/base/status.h"

namespace eyebox::capture {
namespace {

// A buffer description with room for its one plane.
struct Description {
  Description(const VideoNode& node, uint32_t index) {
    buffer.type = node.buffer_type();
    buffer.memory = V4L2_MEMORY_MMAP;
    buffer.index = index;
    if (node.multiplanar()) {
      buffer.m.planes = planes;
      buffer.length = VIDEO_MAX_PLANES;
    }
  }
  Description(const Description&) = delete;
  Description& operator=(const Description&) = delete;

  v4l2_buffer buffer = {};
  v4l2_plane planes[VIDEO_MAX_PLANES] = {};
};

absl::Status RequestBuffers(const VideoNode& node, uint32_t& count) {
  v4l2_requestbuffers request = {};
  request.count = count;
  request.type = node.buffer_type();
  request.memory = V4L2_MEMORY_MMAP;
  absl::Status status = node.Ioctl(VIDIOC_REQBUFS, &request, "provide buffers");
  count = request.count;
  return status;
}

int64_t TimeNs(const v4l2_buffer& buffer) {
  return int64_t{buffer.timestamp.tv_sec} * 1000000000 + int64_t{buffer.timestamp.tv_usec} * 1000;
}

}  // namespace

absl::StatusOr<std::unique_ptr<VideoStream>> VideoStream::Start(const VideoNode& node,
                                                                int buffers) {
  std::unique_ptr<VideoStream> stream(new VideoStream(node));
  EYEBOX_RETURN_IF_ERROR(stream->Allocate(buffers));
  auto type = static_cast<int>(node.buffer_type());
  EYEBOX_RETURN_IF_ERROR(node.Ioctl(VIDIOC_STREAMON, &type, "start streaming"));
  stream->streaming_ = true;
  return stream;
}

// Each step is tried whatever the one before said: an unplugged device refuses all of them, and
// what is ours is given back all the same.
VideoStream::~VideoStream() {
  if (streaming_) {
    auto type = static_cast<int>(node_.buffer_type());
    node_.TryIoctl(VIDIOC_STREAMOFF, &type);
  }
  for (const Mapping& mapping : ring_) node_.syscalls().Munmap(mapping.address, mapping.bytes);
  v4l2_requestbuffers none = {};
  none.type = node_.buffer_type();
  none.memory = V4L2_MEMORY_MMAP;
  node_.TryIoctl(VIDIOC_REQBUFS, &none);
}

absl::Status VideoStream::Allocate(int buffers) {
  auto count = static_cast<uint32_t>(buffers);
  EYEBOX_RETURN_IF_ERROR(RequestBuffers(node_, count));
  if (count < 2) {
    return absl::ResourceExhaustedError(
        Complaint(node_.path(), "has memory for " + std::to_string(count) + " buffers of two",
                  "ask for a smaller size"));
  }
  for (uint32_t index = 0; index < count; ++index) {
    EYEBOX_RETURN_IF_ERROR(Map(index));
    EYEBOX_RETURN_IF_ERROR(Requeue(index));
  }
  return absl::OkStatus();
}

absl::Status VideoStream::Map(uint32_t index) {
  Description description(node_, index);
  EYEBOX_RETURN_IF_ERROR(node_.Ioctl(VIDIOC_QUERYBUF, &description.buffer, "describe its buffers"));
  const bool planes = node_.multiplanar();
  const size_t bytes = planes ? description.planes[0].length : description.buffer.length;
  const uint32_t offset = planes ? description.planes[0].m.mem_offset : description.buffer.m.offset;
  void* address = nullptr;
  const int result = node_.syscalls().Mmap(node_.fd(), offset, bytes, &address);
  if (result < 0) return node_.Failed("map its buffers", -result);
  ring_.push_back({.address = address, .bytes = bytes});
  return absl::OkStatus();
}

absl::StatusOr<std::optional<VideoBuffer>> VideoStream::Dequeue() {
  Description description(node_, 0);
  const v4l2_buffer& buffer = description.buffer;
  const int error_number = node_.TryIoctl(VIDIOC_DQBUF, &description.buffer);
  if (error_number == EAGAIN) return std::nullopt;
  if (error_number != 0) return node_.Failed("deliver a frame", error_number);
  if (buffer.index >= ring_.size()) return node_.Failed("deliver one of its buffers", EIO);
  const bool error = (buffer.flags & V4L2_BUF_FLAG_ERROR) != 0;
  if (!error &&
      (buffer.flags & V4L2_BUF_FLAG_TIMESTAMP_MASK) != V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC) {
    return DeviceFailed(node_.path(), "stamps its frames with another clock than CLOCK_MONOTONIC",
                        "use a camera whose driver does (uvcvideo: load it with clock=monotonic)");
  }
  const Mapping& mapping = ring_[buffer.index];
  const bool planes = node_.multiplanar();
  const size_t used = planes ? description.planes[0].bytesused : buffer.bytesused;
  const size_t begin = std::min<size_t>(planes ? description.planes[0].data_offset : 0, used);
  const std::span<const std::byte> all(static_cast<const std::byte*>(mapping.address),
                                       std::min(used, mapping.bytes));
  return VideoBuffer{.index = buffer.index,
                     .bytes = all.subspan(std::min(begin, all.size())),
                     .sequence = buffer.sequence,
                     .time_ns = TimeNs(buffer),
                     .time_is_start = (buffer.flags & V4L2_BUF_FLAG_TSTAMP_SRC_MASK) ==
                                      V4L2_BUF_FLAG_TSTAMP_SRC_SOE,
                     .error = error};
}

absl::Status VideoStream::Requeue(uint32_t index) {
  Description description(node_, index);
  return node_.Ioctl(VIDIOC_QBUF, &description.buffer, "take a buffer back");
}

absl::StatusOr<StreamEvent> VideoStream::Wait(std::chrono::milliseconds timeout) {
  const int64_t longest = std::numeric_limits<int>::max();
  const auto timeout_ms = static_cast<int>(std::clamp<int64_t>(timeout.count(), 0, longest));
  short returned = 0;
  const int result = node_.syscalls().Poll(node_.fd(), POLLIN | POLLPRI, timeout_ms, &returned);
  if (result == -EINTR || result == 0) return StreamEvent::kNothing;
  if (result < 0) return node_.Failed("wait for a frame", -result);
  if ((returned & POLLIN) != 0) return StreamEvent::kBuffer;
  if ((returned & POLLPRI) != 0) return StreamEvent::kControl;
  return node_.Failed("go on streaming", (returned & POLLHUP) != 0 ? ENODEV : EIO);
}

}  // namespace eyebox::capture
