#include "capture/base/status.h"
#include "service/server/handlers/handlers.h"
#include "service/server/handlers/reply.h"

namespace eyebox::service {

// Answered from the thread that captures; none waits here. A client that goes away takes nothing
// with it: the capture ends up on disk, and its number gives the figures again.
grpc::ServerUnaryReactor* Capture(const HandlerContext& context, grpc::CallbackServerContext* call,
                                  const v1::CaptureRequest* request, v1::CaptureReply* response) {
  grpc::ServerUnaryReactor* reactor = call->DefaultReactor();
  const auto number = JobNumber("name", request->name());
  const auto desk = number.ok() ? context.jobs.DeskOf(*number) : number.status();
  if (!desk.ok()) {
    reactor->Finish(ToRpcStatus(desk.status()));
    return reactor;
  }
  (*desk)->Place(*request, [reactor, response](const absl::StatusOr<v1::CaptureReply>& reply) {
    Reply(reactor, reply, response);
  });
  return reactor;
}

}  // namespace eyebox::service
