// A streaming call that ends with an error before its first message.
#ifndef EYEBOX_SERVICE_SERVER_HANDLERS_FAILED_STREAM_H_
#define EYEBOX_SERVICE_SERVER_HANDLERS_FAILED_STREAM_H_

#include <grpcpp/support/server_callback.h>

#include "absl/status/status.h"
#include "service/server/rpc_status.h"

namespace eyebox::service {

// Deletes itself.
template <typename Message>
class FailedStream final : public grpc::ServerWriteReactor<Message> {
 public:
  explicit FailedStream(const absl::Status& status) { this->Finish(ToRpcStatus(status)); }
  void OnDone() override { delete this; }
};

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_SERVER_HANDLERS_FAILED_STREAM_H_
