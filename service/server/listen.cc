#include "service/server/listen.h"

#include <errno.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstring>
#include <string>
#include <system_error>

#include "capture/base/status.h"
#include "service/server/store/beneath.h"
#include "service/server/store/names.h"

namespace eyebox::service {
namespace {

constexpr std::string_view kUnix = "unix:";
constexpr size_t kMaxPathBytes = sizeof(sockaddr_un::sun_path) - 1;
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

}  // namespace

absl::StatusOr<std::filesystem::path> SocketOf(std::string_view address) {
  if (!address.starts_with(kUnix)) {
    return absl::UnimplementedError(
        Complaint("--listen " + Quoted(address),
                  "only unix sockets are served: TCP needs mutual TLS, which this version lacks",
                  "give unix:PATH, and forward it with ssh -L to reach it from elsewhere"));
  }
  const std::string path(address.substr(kUnix.size()));
  if (path.empty() || path.size() > kMaxPathBytes || path.find('\0') != std::string::npos) {
    return BadInput("--listen",
                    "the path of the socket has " + std::to_string(path.size()) + " bytes",
                    "give unix:PATH with 1 to " + std::to_string(kMaxPathBytes) + " bytes");
  }
  return path;
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
