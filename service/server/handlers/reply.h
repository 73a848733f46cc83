// How a unary call ends.
#ifndef EYEBOX_SERVICE_SERVER_HANDLERS_REPLY_H_
#define EYEBOX_SERVICE_SERVER_HANDLERS_REPLY_H_

#include <grpcpp/support/server_callback.h>

#include <utility>

#include "absl/status/statusor.h"
#include "service/server/rpc_status.h"

namespace eyebox::service {

// With `value` as the response, or with its error.
template <typename Message>
void Reply(grpc::ServerUnaryReactor* reactor, absl::StatusOr<Message> value, Message* response) {
  if (value.ok()) *response = *std::move(value);
  reactor->Finish(ToRpcStatus(value.status()));
}

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_SERVER_HANDLERS_REPLY_H_
