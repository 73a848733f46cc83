#include "service/server/listen.h"

#include <errno.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstring>
#include <string>
#include <system_error>

#include "absl/strings/numbers.h"
#include "capture/base/status.h"
#include "service/server/store/beneath.h"
#include "service/server/store/names.h"

namespace eyebox::service {
namespace {

constexpr std::string_view kUnix = "unix:";
constexpr size_t kMaxPathBytes = sizeof(sockaddr_un::sun_path) - 1;
constexpr size_t kMaxHostCharacters = 253;
constexpr int kMaxPort = 65535;
constexpr std::string_view kHostCharacters =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789.-";
constexpr mode_t kNothingForOthersNoExecute = 0117;

absl::StatusOr<bool> SomeoneListens(const std::filesystem::path& socket_path) {
  const OwnedFd fd(socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  if (fd.get() < 0) return SystemFailed(socket_path.string(), errno, "close unused programs");
  sockaddr_un address = {};
  address.sun_family = AF_UNIX;
  std::memcpy(address.sun_path, socket_path.c_str(), socket_path.native().size());
  if (connect(fd.get(), reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0) {
    return true;
  }
  // EAGAIN: its queue is full, so it has one.
  if (errno == EAGAIN) return true;
  if (errno == ECONNREFUSED) return false;
  return SystemFailed(socket_path.string(), errno, "remove the socket or listen elsewhere");
}

absl::StatusOr<Endpoint> UnixEndpoint(std::string_view path) {
  if (path.empty() || path.size() > kMaxPathBytes || path.find('\0') != std::string_view::npos) {
    return BadInput("--listen",
                    "the path of the socket has " + std::to_string(path.size()) + " bytes",
                    "give unix:PATH with 1 to " + std::to_string(kMaxPathBytes) + " bytes");
  }
  Endpoint endpoint;
  endpoint.socket = path;
  return endpoint;
}

bool IsHost(std::string_view host) {
  if (host.starts_with('[') && host.ends_with(']')) {
    return host.size() > 2 &&
           host.substr(1, host.size() - 2).find_first_not_of("0123456789abcdefABCDEF:.") ==
               std::string_view::npos;
  }
  return !host.empty() && host.size() <= kMaxHostCharacters &&
         host.find_first_not_of(kHostCharacters) == std::string_view::npos;
}

absl::StatusOr<Endpoint> TcpEndpoint(std::string_view address) {
  const size_t colon = address.rfind(':');
  Endpoint endpoint{.tcp = true, .socket = {}, .host = std::string(address.substr(0, colon))};
  if (colon != std::string_view::npos && IsHost(endpoint.host)) {
    const std::string_view port = address.substr(colon + 1);
    const bool digits = !port.empty() && port.find_first_not_of("0123456789") == port.npos;
    if (digits && absl::SimpleAtoi(absl::string_view(port.data(), port.size()), &endpoint.port) &&
        endpoint.port <= kMaxPort) {
      return endpoint;
    }
  }
  return BadInput("--listen", Quoted(address) + " is neither unix:PATH nor HOST:PORT",
                  "give for example unix:eyebox.sock, 127.0.0.1:50051 or [::1]:50051");
}

}  // namespace

std::string Endpoint::ForGrpc() const {
  return tcp ? host + ":" + std::to_string(port) : std::string(kUnix) + socket.string();
}

absl::StatusOr<Endpoint> EndpointOf(std::string_view address) {
  return address.starts_with(kUnix) ? UnixEndpoint(address.substr(kUnix.size()))
                                    : TcpEndpoint(address);
}

absl::Status RemoveStaleSocket(const std::filesystem::path& socket) {
  std::error_code error;
  const auto type = std::filesystem::symlink_status(socket, error).type();
  if (type == std::filesystem::file_type::not_found) return absl::OkStatus();
  if (error) return SystemFailed(socket.string(), error.value(), "listen elsewhere");
  if (type != std::filesystem::file_type::socket) {
    return Rejected(socket.string(), "is there already and is no socket",
                    "remove it or listen elsewhere");
  }
  EYEBOX_ASSIGN_OR_RETURN(const bool alive, SomeoneListens(socket));
  if (alive) {
    return Rejected(socket.string(), "a server listens there already",
                    "stop it or listen elsewhere");
  }
  std::filesystem::remove(socket, error);
  if (error) return SystemFailed(socket.string(), error.value(), "remove it or listen elsewhere");
  return absl::OkStatus();
}

SocketMode::SocketMode() : previous_(umask(kNothingForOthersNoExecute)) {}
SocketMode::~SocketMode() { umask(previous_); }

}  // namespace eyebox::service
