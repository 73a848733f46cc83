// Where the server may listen: a unix socket that only the owner and the group can open.
#ifndef EYEBOX_SERVICE_SERVER_LISTEN_H_
#define EYEBOX_SERVICE_SERVER_LISTEN_H_

#include <filesystem>
#include <string_view>

#include "absl/status/status.h"
#include "absl/status/statusor.h"

namespace eyebox::service {

// The socket of "unix:PATH". Errors: InvalidArgument; Unimplemented for TCP.
absl::StatusOr<std::filesystem::path> SocketOf(std::string_view address);

// Removes a socket that a server left when it was killed. Errors: FailedPrecondition if a server
// answers on it, or if something that is no socket stands there.
absl::Status RemoveStaleSocket(const std::filesystem::path& socket);

// While it lives, sockets are created with mode 0660. Process-wide: no other thread may create
// files meanwhile.
class SocketMode {
 public:
  SocketMode();
  ~SocketMode();
  SocketMode(const SocketMode&) = delete;
  SocketMode& operator=(const SocketMode&) = delete;

 private:
  const unsigned previous_;  // a mode_t
};

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_SERVER_LISTEN_H_
