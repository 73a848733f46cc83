#include <grpcpp/alarm.h>

#include <atomic>
#include <chrono>
#include <memory>

#include "capture/base/status.h"
#include "service/server/handlers/handlers.h"
#include "service/server/handlers/reply.h"
#include "service/server/store/names.h"

namespace eyebox::service {
namespace {

constexpr double kMaxTimeoutS = 300;

// Ends when the job has, when the time is over, when the client goes or when the server stops:
// whichever is first. No thread waits meanwhile.
class WaitCall final : public grpc::ServerUnaryReactor,
                       public std::enable_shared_from_this<WaitCall> {
 public:
  WaitCall(Jobs& jobs, v1::Job* response) : jobs_(jobs), response_(response) {}

  void Start(const v1::WaitJobRequest& request) {
    self_ = shared_from_this();
    const absl::Status status = Begin(request);
    if (!status.ok()) End(status);
  }

  void OnCancel() override { End(absl::CancelledError("the client went away")); }

  void OnDone() override {
    jobs_.table().RemoveListener(number_, listener_);
    self_.reset();
  }

 private:
  absl::Status Begin(const v1::WaitJobRequest& request) {
    EYEBOX_ASSIGN_OR_RETURN(number_, JobNumber("name", request.name()));
    if (!(request.timeout_s() >= 0 && request.timeout_s() <= kMaxTimeoutS)) {
      return BadField("timeout_s", "is " + std::to_string(request.timeout_s()),
                      "give 0 to " + std::to_string(static_cast<int>(kMaxTimeoutS)));
    }
    EYEBOX_ASSIGN_OR_RETURN(
        listener_, jobs_.table().AddListener(number_, [self = self_] { self->EndIfDue(); }));
    const auto timeout = std::chrono::duration_cast<std::chrono::system_clock::duration>(
        std::chrono::duration<double>(request.timeout_s()));
    alarm_.Set(std::chrono::system_clock::now() + timeout, [self = self_](bool over) {
      if (over) self->EndWithJob();
    });
    armed_ = true;
    EndIfDue();
    return absl::OkStatus();
  }

  void EndIfDue() {
    if (!armed_) return;  // Begin looks once more
    const auto job = jobs_.table().Latest(number_);
    if (!job.ok() || HasEnded(*job)) {
      EndWithJob();
    } else if (jobs_.stopping()) {
      End(absl::UnavailableError(
          Complaint("server", "is stopping", "wait for the job again once it is up")));
    }
  }

  void EndWithJob() {
    if (!ended_) End(jobs_.table().Latest(number_));
  }

  void End(const absl::StatusOr<v1::Job>& job) {
    if (ended_.exchange(true)) return;
    const auto self = shared_from_this();
    if (armed_) alarm_.Cancel();
    Reply(this, job, response_);
  }

  Jobs& jobs_;
  v1::Job* const response_;
  int64_t number_ = 0;
  uint64_t listener_ = 0;
  grpc::Alarm alarm_;
  std::atomic<bool> armed_ = false;  // nothing but Begin may end the call before it is
  std::atomic<bool> ended_ = false;
  std::shared_ptr<WaitCall> self_;  // until gRPC is done with the call
};

}  // namespace

grpc::ServerUnaryReactor* WaitJob(const HandlerContext& context, const v1::WaitJobRequest* request,
                                  v1::Job* response) {
  const auto call = std::make_shared<WaitCall>(context.jobs, response);
  call->Start(*request);
  return call.get();
}

}  // namespace eyebox::service
