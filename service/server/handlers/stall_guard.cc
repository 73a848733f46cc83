#include "service/server/handlers/stall_guard.h"

#include <grpcpp/alarm.h>
#include <grpcpp/server_context.h>

#include <cstdint>
#include <mutex>
#include <utility>

namespace eyebox::service {

struct StallGuard::State {
  // Recursive: cancelling a call may end one of its writes before it returns.
  std::recursive_mutex mutex;
  grpc::CallbackServerContext* call = nullptr;  // none: it is over
  std::chrono::milliseconds limit{0};
  std::unique_ptr<grpc::Alarm> alarm;
  bool writing = false;
  uint64_t begun = 0;  // writes so far
  uint64_t seen = 0;   // writes when it was looked at
};

StallGuard::StallGuard(grpc::CallbackServerContext* call, std::chrono::milliseconds limit)
    : state_(std::make_shared<State>()) {
  state_->call = call;
  state_->limit = limit;
  const std::lock_guard lock(state_->mutex);
  Arm(state_);
}

StallGuard::~StallGuard() {
  std::unique_ptr<grpc::Alarm> alarm;  // goes last, without the lock
  const std::lock_guard lock(state_->mutex);
  state_->call = nullptr;
  alarm = std::move(state_->alarm);
}

void StallGuard::WriteBegins() {
  const std::lock_guard lock(state_->mutex);
  state_->writing = true;
  ++state_->begun;
}

void StallGuard::WriteEnds() {
  const std::lock_guard lock(state_->mutex);
  state_->writing = false;
}

void StallGuard::Arm(const std::shared_ptr<State>& state) {
  state->seen = state->begun;
  state->alarm = std::make_unique<grpc::Alarm>();
  state->alarm->Set(std::chrono::system_clock::now() + state->limit, [state](bool rang) {
    if (rang) Look(state);
  });
}

void StallGuard::Look(const std::shared_ptr<State>& state) {
  const std::lock_guard lock(state->mutex);
  if (state->call == nullptr) return;
  if (state->writing && state->begun == state->seen) {
    state->call->TryCancel();
  } else {
    Arm(state);
  }
}

}  // namespace eyebox::service
