#include "capture/camera/v4l2/video_node.h"

#include <errno.h>
#include <linux/videodev2.h>

#include <utility>

#include "absl/status/status.h"
#include "capture/base/status.h"

namespace eyebox::capture {
namespace {

// The kernel promises a terminating zero, a hostile device may not.
template <size_t kSize>
std::string Text(const __u8 (&field)[kSize]) {
  const std::string_view all(reinterpret_cast<const char*>(field), kSize);
  return std::string(all.substr(0, all.find('\0')));
}

absl::Status CannotOpen(const std::string& path, int error_number) {
  if (error_number == ENOENT) {
    return Missing(path, "does not exist", "see `eyebox devices` for the cameras that do");
  }
  if (error_number == EACCES || error_number == EPERM) {
    return absl::PermissionDeniedError(Complaint(path, "may not be opened",
                                                 "add the user to the group of the device, often "
                                                 "`video`"));
  }
  return DeviceFailed(path, "cannot be opened: " + absl::ErrnoToStatus(error_number, "").ToString(),
                      "plug the camera in again");
}

}  // namespace

absl::StatusOr<std::unique_ptr<VideoNode>> VideoNode::Open(std::string path,
                                                           VideoSyscalls* syscalls) {
  int fd = 0;
  do {
    fd = syscalls->Open(path.c_str());
  } while (fd == -EINTR);
  if (fd < 0) return CannotOpen(path, -fd);
  std::unique_ptr<VideoNode> node(new VideoNode(std::move(path), syscalls, fd));
  EYEBOX_RETURN_IF_ERROR(node->QueryCapabilities());
  return node;
}

VideoNode::~VideoNode() { syscalls_->Close(fd_); }

absl::Status VideoNode::QueryCapabilities() {
  v4l2_capability capability = {};
  const int error_number = TryIoctl(VIDIOC_QUERYCAP, &capability);
  if (error_number == ENOTTY || error_number == EINVAL) {
    return BadInput(path_, "is no V4L2 device", "name a /dev/videoN that `eyebox devices` lists");
  }
  if (error_number != 0) return Failed("tell what it can do", error_number);
  driver_ = Text(capability.driver);
  card_ = Text(capability.card);
  bus_ = Text(capability.bus_info);
  const __u32 can = (capability.capabilities & V4L2_CAP_DEVICE_CAPS) != 0 ? capability.device_caps
                                                                          : capability.capabilities;
  multiplanar_ = (can & V4L2_CAP_VIDEO_CAPTURE) == 0;
  buffer_type_ = multiplanar_ ? V4L2_BUF_TYPE_VIDEO_CAPTURE_MPLANE : V4L2_BUF_TYPE_VIDEO_CAPTURE;
  if (multiplanar_ && (can & V4L2_CAP_VIDEO_CAPTURE_MPLANE) == 0) {
    return BadInput(path_, "(" + card_ + ") does not capture video",
                    "name another node of this camera; many have one for metadata beside it");
  }
  if ((can & V4L2_CAP_STREAMING) == 0) {
    return BadInput(path_, "(" + card_ + ") does not stream into memory",
                    "use a camera whose driver does");
  }
  return absl::OkStatus();
}

int VideoNode::TryIoctl(unsigned long request, void* argument) const {
  int result = 0;
  do {
    result = syscalls_->Ioctl(fd_, request, argument);
  } while (result == -EINTR);
  return result < 0 ? -result : 0;
}

absl::Status VideoNode::Ioctl(unsigned long request, void* argument, std::string_view what) const {
  const int error_number = TryIoctl(request, argument);
  return error_number == 0 ? absl::OkStatus() : Failed(what, error_number);
}

absl::Status VideoNode::Failed(std::string_view what, int error_number) const {
  const std::string did = "did not " + std::string(what);
  if (error_number == ENODEV || error_number == ENXIO) {
    return DeviceFailed(path_, did + ": it was unplugged",
                        "plug it in again and open it anew; the captures taken so far are kept");
  }
  if (error_number == EBUSY) {
    return absl::ResourceExhaustedError(
        Complaint(path_, did + ": another program streams from it", "end that program"));
  }
  return DeviceFailed(path_, did + ": " + absl::ErrnoToStatus(error_number, "").ToString(),
                      "see the kernel's log (`dmesg`)");
}

}  // namespace eyebox::capture
