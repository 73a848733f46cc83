// What a worker gives up before it reads foreign data.
#ifndef EYEBOX_SERVICE_SERVER_WORKER_SANDBOX_H_
#define EYEBOX_SERVICE_SERVER_WORKER_SANDBOX_H_

#include "absl/status/status.h"

namespace eyebox::service {

// From here on no thread of this process, and none that it makes, can open a socket, start a
// program, trace another process or change mounts and namespaces: such calls fail with EPERM.
// Errors: Unimplemented (a kernel without seccomp filters).
absl::Status LeaveTheNetwork();

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_SERVER_WORKER_SANDBOX_H_
