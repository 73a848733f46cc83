#include "service/server/handlers/create_job.h"

#include "capture/base/status.h"
#include "service/server/handlers/handlers.h"
#include "service/server/handlers/reply.h"
#include "service/server/handlers/validate_job.h"

namespace eyebox::service {

absl::StatusOr<v1::Job> CreateCheckedJob(const HandlerContext& context,
                                         const v1::CreateJobRequest& request) {
  // A job that is there stays there, whatever became of what it reads.
  EYEBOX_ASSIGN_OR_RETURN(const auto existing, context.jobs.Existing(request));
  if (existing) return *existing;
  EYEBOX_RETURN_IF_ERROR(CheckSources(context.recordings, request));
  return context.jobs.Create(request);
}

grpc::ServerUnaryReactor* CreateJob(const HandlerContext& context,
                                    grpc::CallbackServerContext* call,
                                    const v1::CreateJobRequest* request, v1::Job* response) {
  grpc::ServerUnaryReactor* reactor = call->DefaultReactor();
  const absl::Status valid = ValidateJob(*request);
  if (!valid.ok()) {
    reactor->Finish(ToRpcStatus(valid));
    return reactor;
  }
  context.disk.Post([&context, reactor, request, response] {
    Reply(reactor, CreateCheckedJob(context, *request), response);
  });
  return reactor;
}

}  // namespace eyebox::service
