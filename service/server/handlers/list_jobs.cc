#include <limits>

#include "absl/strings/numbers.h"
#include "capture/base/status.h"
#include "service/server/handlers/handlers.h"
#include "service/server/handlers/reply.h"
#include "service/server/store/names.h"
#include "service/server/store/paging.h"

namespace eyebox::service {
namespace {

// The token is the number of the last job of the page before: jobs created meanwhile shift nothing.
absl::StatusOr<int64_t> BeforeOf(const std::string& token) {
  int64_t before = std::numeric_limits<int64_t>::max();
  if (token.empty()) return before;
  if (!absl::SimpleAtoi(token, &before) || before < 1) {
    return BadField("page_token", Quoted(token) + " is no token",
                    "give the next_page_token of the page before, or none for the first page");
  }
  return before;
}

absl::StatusOr<v1::ListJobsResponse> List(JobTable& table, const v1::ListJobsRequest& request) {
  EYEBOX_ASSIGN_OR_RETURN(const int asked, PageSizeOf(request.page_size()));
  EYEBOX_ASSIGN_OR_RETURN(const int64_t before, BeforeOf(request.page_token()));
  std::vector<v1::Job> page = table.Page(before, asked + 1);
  v1::ListJobsResponse response;
  if (static_cast<int>(page.size()) > asked) {
    page.pop_back();
    EYEBOX_ASSIGN_OR_RETURN(const int64_t last, JobNumber("name", page.back().name()));
    response.set_next_page_token(std::to_string(last));
  }
  *response.mutable_jobs() = {page.begin(), page.end()};
  return response;
}

}  // namespace

grpc::ServerUnaryReactor* ListJobs(const HandlerContext& context, grpc::CallbackServerContext* call,
                                   const v1::ListJobsRequest* request,
                                   v1::ListJobsResponse* response) {
  grpc::ServerUnaryReactor* reactor = call->DefaultReactor();
  Reply(reactor, List(context.jobs.table(), *request), response);
  return reactor;
}

}  // namespace eyebox::service
