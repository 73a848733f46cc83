#include "service/server/rpc_status.h"

#include <string>

namespace eyebox::service {

grpc::Status ToRpcStatus(const absl::Status& status) {
  // Both number the canonical codes as google.rpc.Code does.
  return grpc::Status(static_cast<grpc::StatusCode>(status.code()), std::string(status.message()));
}

}  // namespace eyebox::service
