#include "capture/base/status.h"
#include "service/server/handlers/handlers.h"
#include "service/server/handlers/reply.h"

namespace eyebox::service {
namespace {

absl::StatusOr<v1::Job> Cancel(Jobs& jobs, const std::string& name) {
  EYEBOX_ASSIGN_OR_RETURN(const int64_t number, JobNumber("name", name));
  return jobs.Cancel(number);
}

}  // namespace

grpc::ServerUnaryReactor* CancelJob(const HandlerContext& context,
                                    grpc::CallbackServerContext* call,
                                    const v1::CancelJobRequest* request, v1::Job* response) {
  grpc::ServerUnaryReactor* reactor = call->DefaultReactor();
  context.disk.Post([&context, reactor, request, response] {
    Reply(reactor, Cancel(context.jobs, request->name()), response);
  });
  return reactor;
}

}  // namespace eyebox::service
