// Gives up a stream whose client reads nothing.
#ifndef EYEBOX_SERVICE_SERVER_HANDLERS_STALL_GUARD_H_
#define EYEBOX_SERVICE_SERVER_HANDLERS_STALL_GUARD_H_

#include <grpcpp/support/server_callback.h>

#include <chrono>
#include <memory>

namespace eyebox::service {

// Of one call, a member of its reactor. No thread waits; any thread may call.
class StallGuard {
 public:
  // A write that is not taken within `limit` cancels the call, after twice as long at the latest:
  // it is looked at once every `limit`, so that a write costs nothing.
  StallGuard(grpc::CallbackServerContext* call, std::chrono::milliseconds limit);
  // The call is over: it is not touched any more.
  ~StallGuard();
  StallGuard(const StallGuard&) = delete;
  StallGuard& operator=(const StallGuard&) = delete;

  // Before StartWrite() and its kin, and in OnWriteDone().
  void WriteBegins();
  void WriteEnds();

 private:
  struct State;
  static void Arm(const std::shared_ptr<State>& state);
  static void Look(const std::shared_ptr<State>& state);

  const std::shared_ptr<State> state_;
};

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_SERVER_HANDLERS_STALL_GUARD_H_
