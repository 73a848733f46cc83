// Where the server may listen: a unix socket that only the owner and the group can open, or TCP.
#ifndef EYEBOX_SERVICE_SERVER_LISTEN_H_
#define EYEBOX_SERVICE_SERVER_LISTEN_H_

#include <filesystem>
#include <string>
#include <string_view>

#include "absl/status/status.h"
#include "absl/status/statusor.h"

namespace eyebox::service {

struct Endpoint {
  bool tcp = false;
  std::filesystem::path socket;  // of "unix:PATH"
  std::string host;              // of "HOST:PORT"; an IPv6 address keeps its brackets
  int port = 0;                  // 0: one that is free

  std::string ForGrpc() const;
};

// What "unix:PATH" or "HOST:PORT" says. Errors: InvalidArgument.
absl::StatusOr<Endpoint> EndpointOf(std::string_view address);

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
