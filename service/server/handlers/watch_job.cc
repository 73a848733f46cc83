#include <memory>
#include <mutex>
#include <optional>

#include "capture/base/status.h"
#include "service/server/handlers/failed_stream.h"
#include "service/server/handlers/handlers.h"
#include "service/server/handlers/stall_guard.h"
#include "service/server/rpc_status.h"
#include "service/server/store/names.h"

namespace eyebox::service {
namespace {

// Writes one event at a time, so that a slow client holds back nobody and costs one event of
// memory. Events come from the table; a listener says when to look again.
class WatchCall final : public grpc::ServerWriteReactor<v1::JobEvent>,
                        public std::enable_shared_from_this<WatchCall> {
 public:
  WatchCall(const HandlerContext& context, grpc::CallbackServerContext* call, int64_t number,
            uint32_t from)
      : jobs_(context.jobs), number_(number), next_(from) {
    guard_.emplace(call, context.stalled_after);
  }

  absl::Status Start() {
    self_ = shared_from_this();
    const auto listener = jobs_.table().AddListener(number_, [self = self_] { self->Advance(); });
    if (!listener.ok()) {
      self_.reset();
      return listener.status();
    }
    listener_ = *listener;
    Advance();
    return absl::OkStatus();
  }

  void OnWriteDone(bool ok) override {
    guard_->WriteEnds();
    {
      const std::lock_guard lock(mutex_);
      writing_ = false;
      gone_ = gone_ || !ok;
    }
    Advance();
  }

  void OnCancel() override {
    {
      const std::lock_guard lock(mutex_);
      gone_ = true;
    }
    Advance();
  }

  void OnDone() override {
    guard_.reset();  // a listener may keep this a moment longer than the call lives
    jobs_.table().RemoveListener(number_, listener_);
    self_.reset();
  }

 private:
  // Does the one thing that is due, if any: write the next event or finish.
  void Advance() {
    std::optional<grpc::Status> end;
    {
      const std::lock_guard lock(mutex_);
      if (writing_ || finished_) return;
      end = EndIfDue();
      finished_ = end.has_value();
      writing_ = !finished_ && TakeNext();
      if (!finished_ && !writing_) return;
    }
    if (end) {
      Finish(*end);
    } else {
      guard_->WriteBegins();
      StartWrite(&event_);
    }
  }

  std::optional<grpc::Status> EndIfDue() const {
    if (gone_) return grpc::Status(grpc::StatusCode::CANCELLED, "the client went away");
    if (HasEnded(event_.job())) return grpc::Status::OK;
    if (!jobs_.stopping()) return std::nullopt;
    return ToRpcStatus(absl::UnavailableError(
        Complaint("server", "is stopping",
                  "watch again from sequence " + std::to_string(next_) + " once it is up")));
  }

  bool TakeNext() {
    auto event = jobs_.table().Event(number_, next_);
    if (!event.ok() || !*event) return false;
    event_ = **std::move(event);
    ++next_;
    return true;
  }

  Jobs& jobs_;
  const int64_t number_;
  std::optional<StallGuard> guard_;
  uint64_t listener_ = 0;
  std::shared_ptr<WatchCall> self_;  // until gRPC is done with the call

  std::mutex mutex_;
  uint32_t next_;
  v1::JobEvent event_;  // being written, or written last
  bool writing_ = false;
  bool gone_ = false;
  bool finished_ = false;
};

absl::Status CheckFrom(JobTable& table, int64_t number, uint32_t from) {
  EYEBOX_ASSIGN_OR_RETURN(const v1::Job job, table.Latest(number));
  if (!HasEnded(job) || from <= job.last_sequence()) return absl::OkStatus();
  return WithField(
      absl::OutOfRangeError(Complaint(
          "from_sequence", "the job ended with event " + std::to_string(job.last_sequence()),
          "read its state with GetJob")),
      "from_sequence");
}

absl::StatusOr<grpc::ServerWriteReactor<v1::JobEvent>*> Watch(const HandlerContext& context,
                                                              grpc::CallbackServerContext* call,
                                                              const v1::WatchJobRequest& request) {
  EYEBOX_ASSIGN_OR_RETURN(const int64_t number, JobNumber("name", request.name()));
  EYEBOX_RETURN_IF_ERROR(CheckFrom(context.jobs.table(), number, request.from_sequence()));
  const uint32_t from = request.from_sequence() == 0 ? 1 : request.from_sequence();
  const auto watch = std::make_shared<WatchCall>(context, call, number, from);
  EYEBOX_RETURN_IF_ERROR(watch->Start());
  return watch.get();
}

}  // namespace

grpc::ServerWriteReactor<v1::JobEvent>* WatchJob(const HandlerContext& context,
                                                 grpc::CallbackServerContext* call,
                                                 const v1::WatchJobRequest* request) {
  const auto watch = Watch(context, call, *request);
  return watch.ok() ? *watch : new FailedStream<v1::JobEvent>(watch.status());
}

}  // namespace eyebox::service
