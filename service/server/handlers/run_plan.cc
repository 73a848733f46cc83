#include <algorithm>
#include <memory>
#include <mutex>

#include "capture/base/status.h"
#include "service/server/handlers/handlers.h"
#include "service/server/handlers/stimulus_step.h"
#include "service/server/rpc_status.h"

namespace eyebox::service {
namespace {

// Tells one client what to show. One message is read and one written at a time; the desk of the job
// keeps everything else, so a client may go and come back.
class RunPlanCall final : public grpc::ServerBidiReactor<v1::RunPlanRequest, v1::StimulusStep>,
                          public std::enable_shared_from_this<RunPlanCall> {
 public:
  explicit RunPlanCall(Jobs& jobs) : jobs_(jobs) {}

  void Start() {
    self_ = shared_from_this();
    StartRead(&request_);
  }

  void OnReadDone(bool ok) override {
    if (!ok) return End(absl::OkStatus());  // the client says no more; the job goes on
    const absl::Status heard = number_ == 0 ? Attach() : Acknowledge();
    if (!heard.ok()) return End(heard);
    {
      const std::lock_guard lock(mutex_);
      if (finished_) return;
      StartRead(&request_);
    }
    Advance();
  }

  void OnWriteDone(bool ok) override {
    {
      const std::lock_guard lock(mutex_);
      writing_ = false;
    }
    if (!ok) return End(absl::CancelledError("the client went away"));
    Advance();
  }

  void OnCancel() override { End(absl::CancelledError("the client went away")); }

  void OnDone() override {
    if (number_ != 0) jobs_.table().RemoveListener(number_, listener_);
    self_.reset();
  }

 private:
  absl::Status Attach() {
    EYEBOX_ASSIGN_OR_RETURN(const int64_t number, JobNumber("name", request_.name()));
    EYEBOX_RETURN_IF_ERROR(StepAfter(jobs_, number, 0).status());
    EYEBOX_ASSIGN_OR_RETURN(listener_,
                            jobs_.table().AddListener(number, [self = self_] { self->Advance(); }));
    const std::lock_guard lock(mutex_);
    number_ = number;
    return absl::OkStatus();
  }

  absl::Status Acknowledge() {
    const auto desk = jobs_.DeskOf(number_);
    // It ended, or is about to begin anew: then the acknowledgement is of no use, and no fault.
    if (!desk.ok()) return absl::OkStatus();
    const absl::Status shown = (*desk)->Shown(request_.shown_step());
    return absl::IsUnavailable(shown) ? absl::OkStatus() : shown;
  }

  // Writes what is new, or ends. gRPC runs no reaction inside StartWrite and Finish, so they may be
  // called under the lock, and must be: no write may follow the end.
  void Advance() {
    const std::lock_guard lock(mutex_);
    if (writing_ || finished_ || number_ == 0) return;
    const auto step = StepAfter(jobs_, number_, sent_);
    if (!step.ok()) return EndLocked(step.status());
    if (told_end_) return EndLocked(absl::OkStatus());
    if (step->step() != 0 || HasEnded(step->job())) {
      told_end_ = HasEnded(step->job());
      sent_ = std::max(sent_, step->step());
      step_ = *step;
      writing_ = true;
      StartWrite(&step_);
    } else if (jobs_.stopping()) {
      EndLocked(absl::UnavailableError(
          Complaint("server", "is stopping", "open RunPlan again once it is up")));
    }
  }

  void End(const absl::Status& status) {
    const std::lock_guard lock(mutex_);
    EndLocked(status);
  }

  void EndLocked(const absl::Status& status) {
    if (finished_) return;
    finished_ = true;
    Finish(ToRpcStatus(status));
  }

  Jobs& jobs_;
  v1::RunPlanRequest request_;  // being read, or read last
  uint64_t listener_ = 0;
  std::shared_ptr<RunPlanCall> self_;  // until gRPC is done with the call

  std::mutex mutex_;
  int64_t number_ = 0;     // of the job, once the client named it
  v1::StimulusStep step_;  // being written, or written last
  uint64_t sent_ = 0;
  bool writing_ = false;
  bool told_end_ = false;
  bool finished_ = false;
};

}  // namespace

grpc::ServerBidiReactor<v1::RunPlanRequest, v1::StimulusStep>* RunPlan(
    const HandlerContext& context) {
  const auto call = std::make_shared<RunPlanCall>(context.jobs);
  call->Start();
  return call.get();
}

}  // namespace eyebox::service
