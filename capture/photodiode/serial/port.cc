#include "capture/photodiode/serial/port.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "capture/base/status.h"

namespace eyebox::capture::serial {
namespace {

constexpr speed_t kBaud = B500000;
constexpr int kWriteTimeoutMs = 1000;

// flock keeps out every program that asks for it, root's too; TIOCEXCL those that do not ask.
absl::Status Claim(const std::string& device, int fd) {
  if (isatty(fd) == 0) {
    return BadInput(device, "is no serial port", "name one, like serial:/dev/ttyACM0");
  }
  if (flock(fd, LOCK_EX | LOCK_NB) != 0) {
    if (errno != EWOULDBLOCK) return SystemFailed(device, errno, "the port cannot be locked");
    return absl::ResourceExhaustedError(
        Complaint(device, "is in use", "close the program that has it open (see lsof)"));
  }
  if (ioctl(fd, TIOCEXCL) != 0) return SystemFailed(device, errno, "the port cannot be claimed");
  return absl::OkStatus();
}

absl::Status MakeRaw(const std::string& device, int fd) {
  termios wanted{};
  if (tcgetattr(fd, &wanted) != 0) return SystemFailed(device, errno, "its settings are hidden");
  cfmakeraw(&wanted);
  wanted.c_cflag |= CLOCAL | CREAD;
  wanted.c_cflag &= ~(CSTOPB | CRTSCTS | HUPCL);
  wanted.c_iflag &= ~(IXOFF | IXANY);
  wanted.c_cc[VMIN] = 0;
  wanted.c_cc[VTIME] = 0;
  cfsetispeed(&wanted, kBaud);
  cfsetospeed(&wanted, kBaud);
  // tcsetattr succeeds when any one of the settings was taken, so that they are read back.
  termios taken{};
  if (tcsetattr(fd, TCSANOW, &wanted) != 0 || tcgetattr(fd, &taken) != 0) {
    return SystemFailed(device, errno, "its settings cannot be changed");
  }
  if (taken.c_cflag == wanted.c_cflag && taken.c_iflag == wanted.c_iflag &&
      taken.c_lflag == wanted.c_lflag && taken.c_oflag == wanted.c_oflag &&
      cfgetospeed(&taken) == kBaud) {
    tcflush(fd, TCIOFLUSH);
    return absl::OkStatus();
  }
  return DeviceFailed(device, "does not take 500000 baud, 8N1, raw", "use an Arduino UNO");
}

}  // namespace

absl::StatusOr<std::unique_ptr<Port>> Port::Open(const std::string& device) {
  const int fd = open(device.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (fd < 0 && errno == EBUSY) {  // TIOCEXCL of another program
    return absl::ResourceExhaustedError(
        Complaint(device, "is in use", "close the program that has it open (see lsof)"));
  }
  if (fd < 0) return SystemFailed(device, errno, "check the name, and that you are in 'dialout'");
  auto port = std::unique_ptr<Port>(new Port(device, fd));
  EYEBOX_RETURN_IF_ERROR(Claim(device, fd));
  EYEBOX_RETURN_IF_ERROR(MakeRaw(device, fd));
  return port;
}

Port::~Port() { close(fd_); }

absl::Status Port::Unplugged(int error_number) const {
  return DeviceFailed(device_,
                      error_number == 0 ? "hung up" : std::string(std::strerror(error_number)),
                      "check the cable, then open it again");
}

absl::StatusOr<size_t> Port::Read(std::span<uint8_t> bytes, std::chrono::milliseconds timeout) {
  pollfd waiting = {.fd = fd_, .events = POLLIN, .revents = 0};
  const int ready = poll(&waiting, 1, static_cast<int>(timeout.count()));
  if (ready < 0 && errno != EINTR) return Unplugged(errno);
  if (ready <= 0) return size_t{0};
  const ssize_t count = read(fd_, bytes.data(), bytes.size());
  if (count > 0) return static_cast<size_t>(count);
  if (count < 0 && (errno == EAGAIN || errno == EINTR)) return size_t{0};
  return Unplugged(count < 0 ? errno : 0);
}

absl::Status Port::Write(std::span<const uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t count = write(fd_, bytes.data(), bytes.size());
    if (count > 0) {
      bytes = bytes.subspan(static_cast<size_t>(count));
      continue;
    }
    if (count < 0 && errno == EINTR) continue;
    if (count < 0 && errno != EAGAIN) return Unplugged(errno);
    pollfd waiting = {.fd = fd_, .events = POLLOUT, .revents = 0};
    if (poll(&waiting, 1, kWriteTimeoutMs) == 0) return Unplugged(ETIMEDOUT);
  }
  return absl::OkStatus();
}

}  // namespace eyebox::capture::serial
