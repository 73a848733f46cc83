// The system calls that the V4L2 camera makes: the seam at which tests put a device of their own.
#ifndef EYEBOX_CAPTURE_CAMERA_V4L2_VIDEO_SYSCALLS_H_
#define EYEBOX_CAPTURE_CAMERA_V4L2_VIDEO_SYSCALLS_H_

#include <cstddef>
#include <cstdint>

namespace eyebox::capture {

// The kernel's own convention: every call returns a negative errno value where it fails. EINTR is
// passed on; the caller repeats.
class VideoSyscalls {
 public:
  virtual ~VideoSyscalls() = default;
  virtual int Open(const char* path) = 0;  // for reading and writing, non-blocking; returns the fd
  virtual int Close(int fd) = 0;
  virtual int Ioctl(int fd, unsigned long request, void* argument) = 0;
  virtual int Mmap(int fd, int64_t offset, size_t length, void** address) = 0;
  virtual int Munmap(void* address, size_t length) = 0;
  // Waits for `events` (poll.h); returns 0 after the timeout, else 1 with *returned filled.
  virtual int Poll(int fd, short events, int timeout_ms, short* returned) = 0;
};

// Those of the operating system; never null, never freed, thread-safe.
VideoSyscalls* KernelVideoSyscalls();

}  // namespace eyebox::capture

#endif  // EYEBOX_CAPTURE_CAMERA_V4L2_VIDEO_SYSCALLS_H_
