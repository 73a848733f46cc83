#include "capture/camera/aravis/socket_buffer.h"

#include <arpa/inet.h>
#include <dirent.h>
#include <sys/socket.h>

#include <memory>
#include <optional>

#include "absl/strings/numbers.h"
#include "capture/base/status.h"

namespace eyebox::capture::aravis {
namespace {

constexpr int kLeastBytes = 4 << 20;

bool IsUdpSocketOfPort(int fd, uint16_t port) {
  int type = 0;
  socklen_t type_size = sizeof type;
  if (getsockopt(fd, SOL_SOCKET, SO_TYPE, &type, &type_size) != 0 || type != SOCK_DGRAM) {
    return false;
  }
  sockaddr_in address = {};
  socklen_t size = sizeof address;
  return getsockname(fd, reinterpret_cast<sockaddr*>(&address), &size) == 0 &&
         address.sin_family == AF_INET && ntohs(address.sin_port) == port;
}

std::optional<int> FindUdpSocket(uint16_t port) {
  const std::unique_ptr<DIR, int (*)(DIR*)> folder(opendir("/proc/self/fd"), closedir);
  if (!folder) return std::nullopt;
  while (const dirent* entry = readdir(folder.get())) {
    int fd = 0;
    if (absl::SimpleAtoi(entry->d_name, &fd) && IsUdpSocketOfPort(fd, port)) return fd;
  }
  return std::nullopt;
}

}  // namespace

absl::Status EnlargeSocketBuffer(const std::string& uri, uint16_t port, int bytes) {
  const std::optional<int> fd = FindUdpSocket(port);
  if (!fd) {
    return DeviceFailed(uri, "has no UDP socket on port " + std::to_string(port),
                        "open the camera again");
  }
  // Beyond net.core.rmem_max only with CAP_NET_ADMIN.
  if (setsockopt(*fd, SOL_SOCKET, SO_RCVBUFFORCE, &bytes, sizeof bytes) == 0) {
    return absl::OkStatus();
  }
  setsockopt(*fd, SOL_SOCKET, SO_RCVBUF, &bytes, sizeof bytes);
  int granted = 0;
  socklen_t size = sizeof granted;
  // The kernel reports twice what may be used, the other half being its own bookkeeping.
  if (getsockopt(*fd, SOL_SOCKET, SO_RCVBUF, &granted, &size) == 0 && granted / 2 >= kLeastBytes) {
    return absl::OkStatus();
  }
  return DeviceFailed(
      uri,
      "gets a socket buffer of " + std::to_string(granted / 2) + " bytes, in which frames are lost",
      "run: sysctl -w net.core.rmem_max=" + std::to_string(bytes));
}

}  // namespace eyebox::capture::aravis
