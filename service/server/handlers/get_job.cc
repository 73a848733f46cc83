#include "capture/base/status.h"
#include "service/server/handlers/handlers.h"
#include "service/server/handlers/reply.h"

namespace eyebox::service {
namespace {

absl::StatusOr<v1::Job> Get(JobTable& table, const std::string& name) {
  EYEBOX_ASSIGN_OR_RETURN(const int64_t number, JobNumber("name", name));
  return table.Latest(number);
}

}  // namespace

grpc::ServerUnaryReactor* GetJob(const HandlerContext& context, grpc::CallbackServerContext* call,
                                 const v1::GetJobRequest* request, v1::Job* response) {
  grpc::ServerUnaryReactor* reactor = call->DefaultReactor();
  Reply(reactor, Get(context.jobs.table(), request->name()), response);
  return reactor;
}

}  // namespace eyebox::service
