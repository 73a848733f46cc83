// One open /dev/videoN that captures.
#ifndef EYEBOX_CAPTURE_CAMERA_V4L2_VIDEO_NODE_H_
#define EYEBOX_CAPTURE_CAMERA_V4L2_VIDEO_NODE_H_

#include <memory>
#include <string>
#include <string_view>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "capture/camera/v4l2/video_syscalls.h"

namespace eyebox::capture {

// Not thread-safe. Closes the device at its end.
class VideoNode {
 public:
  // `syscalls` must outlive the node. Errors: NotFound (no such device), PermissionDenied,
  // InvalidArgument (it does not stream video in), Unavailable (unplugged).
  static absl::StatusOr<std::unique_ptr<VideoNode>> Open(std::string path, VideoSyscalls* syscalls);
  ~VideoNode();
  VideoNode(const VideoNode&) = delete;
  VideoNode& operator=(const VideoNode&) = delete;

  // 0 or a positive errno value; interrupted calls are repeated.
  int TryIoctl(unsigned long request, void* argument) const;
  // `what` ("set the format") stands in the message. Errors: Unavailable (unplugged, or whatever
  // else the driver says), ResourceExhausted (busy: someone else streams).
  absl::Status Ioctl(unsigned long request, void* argument, std::string_view what) const;
  // The status of a call that failed with this errno value.
  absl::Status Failed(std::string_view what, int error_number) const;

  const std::string& path() const { return path_; }
  const std::string& driver() const { return driver_; }
  const std::string& card() const { return card_; }
  const std::string& bus() const { return bus_; }
  unsigned buffer_type() const { return buffer_type_; }  // enum v4l2_buf_type
  bool multiplanar() const { return multiplanar_; }
  VideoSyscalls& syscalls() const { return *syscalls_; }
  int fd() const { return fd_; }

 private:
  VideoNode(std::string path, VideoSyscalls* syscalls, int fd)
      : path_(std::move(path)), syscalls_(syscalls), fd_(fd) {}
  absl::Status QueryCapabilities();

  const std::string path_;
  VideoSyscalls* const syscalls_;
  const int fd_;
  std::string driver_;
  std::string card_;
  std::string bus_;
  unsigned buffer_type_ = 0;
  bool multiplanar_ = false;
};

}  // namespace eyebox::capture

#endif  // EYEBOX_CAPTURE_CAMERA_V4L2_VIDEO_NODE_H_
