#include "capture/base/status.h"
#include "service/server/handlers/handlers.h"
#include "service/server/handlers/reply.h"
#include "service/server/handlers/validate_run.h"
#include "service/server/store/names.h"

namespace eyebox::service {
namespace {

absl::StatusOr<v1::Job> Create(const HandlerContext& context, const v1::CreateRunRequest& request) {
  // A job that is there stays there, whatever became of its recording.
  EYEBOX_ASSIGN_OR_RETURN(const auto existing, context.jobs.Existing(request));
  if (existing) return *existing;
  if (request.has_recording()) {
    const auto folder = context.recordings.OpenFolder(request.recording());
    if (!folder.ok()) return WithField(folder.status(), "recording");
  }
  return context.jobs.Create(request);
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
    Reply(reactor, Create(context, *request), response);
  });
  return reactor;
}

}  // namespace eyebox::service
