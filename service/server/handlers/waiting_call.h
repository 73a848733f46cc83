// A unary call that answers when something has happened to a job, or its time is over.
#ifndef EYEBOX_SERVICE_SERVER_HANDLERS_WAITING_CALL_H_
#define EYEBOX_SERVICE_SERVER_HANDLERS_WAITING_CALL_H_

#include <grpcpp/alarm.h>
#include <grpcpp/support/server_callback.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "absl/status/statusor.h"
#include "capture/base/status.h"
#include "service/server/handlers/reply.h"
#include "service/server/jobs/jobs.h"
#include "service/server/store/names.h"

namespace eyebox::service {

// Ends when `look` has an answer, when the time is over, when the client goes or when the server
// stops: whichever is first. No thread waits meanwhile.
template <typename Message>
class WaitingCall final : public grpc::ServerUnaryReactor,
                          public std::enable_shared_from_this<WaitingCall<Message>> {
 public:
  // What the call answers; nothing while it goes on. `over`: the time is, so it must answer.
  using Look = std::function<std::optional<absl::StatusOr<Message>>(int64_t number, bool over)>;

  static constexpr double kMaxTimeoutS = 300;

  // Deletes itself once gRPC is done with it.
  static grpc::ServerUnaryReactor* Start(Jobs& jobs, const std::string& name, double timeout_s,
                                         Look look, Message* response) {
    const std::shared_ptr<WaitingCall> call(new WaitingCall(jobs, std::move(look), response));
    call->self_ = call;
    const absl::Status status = call->Begin(name, timeout_s);
    if (!status.ok()) call->End(status);
    return call.get();
  }

  void OnCancel() override { End(absl::CancelledError("the client went away")); }

  void OnDone() override {
    jobs_.table().RemoveListener(number_, listener_);
    self_.reset();
  }

 private:
  WaitingCall(Jobs& jobs, Look look, Message* response)
      : jobs_(jobs), look_(std::move(look)), response_(response) {}

  absl::Status Begin(const std::string& name, double timeout_s) {
    EYEBOX_ASSIGN_OR_RETURN(number_, JobNumber("name", name));
    if (!(timeout_s >= 0 && timeout_s <= kMaxTimeoutS)) {
      return BadField("timeout_s", "is " + std::to_string(timeout_s),
                      "give 0 to " + std::to_string(static_cast<int>(kMaxTimeoutS)));
    }
    EYEBOX_ASSIGN_OR_RETURN(
        listener_, jobs_.table().AddListener(number_, [self = self_] { self->EndIfDue(false); }));
    const auto timeout = std::chrono::duration_cast<std::chrono::system_clock::duration>(
        std::chrono::duration<double>(timeout_s));
    alarm_.Set(std::chrono::system_clock::now() + timeout, [self = self_](bool over) {
      if (over) self->EndIfDue(true);
    });
    armed_ = true;
    EndIfDue(false);
    return absl::OkStatus();
  }

  void EndIfDue(bool over) {
    if (!armed_ || ended_) return;  // before it is armed: Begin looks once more
    if (auto answer = look_(number_, over)) {
      End(*std::move(answer));
    } else if (jobs_.stopping()) {
      End(absl::UnavailableError(
          Complaint("server", "is stopping", "wait for the job again once it is up")));
    }
  }

  void End(const absl::StatusOr<Message>& answer) {
    if (ended_.exchange(true)) return;
    const auto self = this->shared_from_this();
    if (armed_) alarm_.Cancel();
    Reply(this, answer, response_);
  }

  Jobs& jobs_;
  const Look look_;
  Message* const response_;
  int64_t number_ = 0;
  uint64_t listener_ = 0;
  grpc::Alarm alarm_;
  std::atomic<bool> armed_ = false;  // nothing but Begin may end the call before it is
  std::atomic<bool> ended_ = false;
  std::shared_ptr<WaitingCall> self_;  // until gRPC is done with the call
};

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_SERVER_HANDLERS_WAITING_CALL_H_
