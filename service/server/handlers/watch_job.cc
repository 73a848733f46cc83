#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "capture/base/status.h"
#include "service/server/handlers/failed_stream.h"
#include "service/server/handlers/guarded_stream.h"
#include "service/server/handlers/handlers.h"
#include "service/server/rpc_status.h"
#include "service/server/store/names.h"

namespace eyebox::service {
namespace {

// Events come from the table; a listener says when to look again.
class WatchCall final : public GuardedStream<v1::JobEvent> {
 public:
  WatchCall(const HandlerContext& context, grpc::CallbackServerContext* call, int64_t number,
            uint32_t from)
      : GuardedStream(call, context.stalled_after),
        jobs_(context.jobs),
        number_(number),
        next_(from) {}

  absl::Status Start() {
    const auto listener = jobs_.table().AddListener(number_, [this, self = Hold()] { Advance(); });
    if (!listener.ok()) {
      Release();
      return listener.status();
    }
    listener_ = *listener;
    Advance();
    return absl::OkStatus();
  }

 private:
  std::optional<grpc::Status> EndIfDue() override {
    if (HasEnded(message().job())) return grpc::Status::OK;
    if (!jobs_.stopping()) return std::nullopt;
    return ToRpcStatus(absl::UnavailableError(
        Complaint("server", "is stopping",
                  "watch again from sequence " + std::to_string(next_) + " once it is up")));
  }

  bool TakeNext(v1::JobEvent& event) override {
    auto next = jobs_.table().Event(number_, next_);
    if (!next.ok() || !*next) return false;
    event = **std::move(next);
    ++next_;
    return true;
  }

  void Leave() override { jobs_.table().RemoveListener(number_, listener_); }

  Jobs& jobs_;
  const int64_t number_;
  uint64_t listener_ = 0;
  uint32_t next_;
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
