#include "capture/base/status.h"
#include "service/result_json.h"
#include "service/server/handlers/handlers.h"
#include "service/server/handlers/reply.h"
#include "service/server/handlers/result_files.h"

namespace eyebox::service {
namespace {

// Written by the pipeline; doubles read back to the same bits.
constexpr char kResultFile[] = "result.json";

absl::StatusOr<v1::RunResult> Result(Jobs& jobs, const std::string& name) {
  EYEBOX_RETURN_IF_ERROR(SucceededJob(jobs, name).status());
  EYEBOX_ASSIGN_OR_RETURN(const int64_t number, JobNumber("name", name));
  v1::RunResult result;
  EYEBOX_RETURN_IF_ERROR(ReadJson(jobs.ResultOf(number) / kResultFile, result));
  return result;
}

}  // namespace

grpc::ServerUnaryReactor* GetRunResult(const HandlerContext& context,
                                       grpc::CallbackServerContext* call,
                                       const v1::GetRunResultRequest* request,
                                       v1::RunResult* response) {
  grpc::ServerUnaryReactor* reactor = call->DefaultReactor();
  context.disk.Post([&context, reactor, request, response] {
    Reply(reactor, Result(context.jobs, request->name()), response);
  });
  return reactor;
}

}  // namespace eyebox::service
