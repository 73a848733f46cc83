// Errors as gRPC carries them.
#ifndef EYEBOX_SERVICE_SERVER_RPC_STATUS_H_
#define EYEBOX_SERVICE_SERVER_RPC_STATUS_H_

#include <grpcpp/support/status.h>

#include "absl/status/status.h"

namespace eyebox::service {

// Same canonical code and message, and as details (google.rpc.Status in grpc-status-details-bin)
// an ErrorInfo and, if the status names a field, a BadRequest with it.
grpc::Status ToRpcStatus(const absl::Status& status);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_SERVER_RPC_STATUS_H_
