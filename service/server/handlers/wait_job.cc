#include <optional>

#include "service/server/handlers/handlers.h"
#include "service/server/handlers/waiting_call.h"

namespace eyebox::service {

grpc::ServerUnaryReactor* WaitJob(const HandlerContext& context, const v1::WaitJobRequest* request,
                                  v1::Job* response) {
  const auto look = [&table = context.jobs.table()](
                        int64_t number, bool over) -> std::optional<absl::StatusOr<v1::Job>> {
    auto job = table.Latest(number);
    if (over || !job.ok() || HasEnded(*job)) return job;
    return std::nullopt;
  };
  return WaitingCall<v1::Job>::Start(context.jobs, request->name(), request->timeout_s(), look,
                                     response);
}

}  // namespace eyebox::service
