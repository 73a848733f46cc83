#include "capture/camera/v4l2/video_syscalls.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <unistd.h>

namespace eyebox::capture {
namespace {

int OrErrno(int result) { return result < 0 ? -errno : result; }

class KernelCalls final : public VideoSyscalls {
 public:
  int Open(const char* path) override {
    return OrErrno(::open(path, O_RDWR | O_NONBLOCK | O_CLOEXEC));
  }
  int Close(int fd) override { return OrErrno(::close(fd)); }
  int Ioctl(int fd, unsigned long request, void* argument) override {
    return OrErrno(::ioctl(fd, request, argument));
  }
  int Mmap(int fd, int64_t offset, size_t length, void** address) override {
    *address = ::mmap(nullptr, length, PROT_READ | PROT_WRITE, MAP_SHARED, fd, offset);
    return *address == MAP_FAILED ? -errno : 0;
  }
  int Munmap(void* address, size_t length) override { return OrErrno(::munmap(address, length)); }
  int Poll(int fd, short events, int timeout_ms, short* returned) override {
    pollfd descriptor = {.fd = fd, .events = events, .revents = 0};
    const int result = OrErrno(::poll(&descriptor, 1, timeout_ms));
    *returned = descriptor.revents;
    return result;
  }
};

}  // namespace

VideoSyscalls* KernelVideoSyscalls() {
  static KernelCalls* const calls = new KernelCalls;
  return calls;
}

}  // namespace eyebox::capture
