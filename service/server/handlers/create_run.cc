#include "service/server/handlers/create_job.h"
#include "service/server/handlers/handlers.h"
#include "service/server/handlers/reply.h"
#include "service/server/handlers/validate_run.h"

namespace eyebox::service {
namespace {

v1::CreateJobRequest JobOf(const v1::CreateRunRequest& request) {
  v1::CreateJobRequest job;
  job.set_request_id(request.request_id());
  *job.mutable_run() = request;
  job.mutable_run()->clear_request_id();
  return job;
}

}  // namespace

grpc::ServerUnaryReactor* CreateRun(const HandlerContext& context,
                                    grpc::CallbackServerContext* call,
                                    const v1::CreateRunRequest* request, v1::Job* response) {
  grpc::ServerUnaryReactor* reactor = call->DefaultReactor();
  const absl::Status valid = ValidateRun(*request);
  if (!valid.ok()) {
    reactor->Finish(ToRpcStatus(valid));
    return reactor;
  }
  context.disk.Post([&context, reactor, request, response] {
    Reply(reactor, CreateCheckedJob(context, JobOf(*request)), response);
  });
  return reactor;
}

}  // namespace eyebox::service
