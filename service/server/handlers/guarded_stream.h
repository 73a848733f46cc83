// A stream that writes one message at a time, so that a slow client holds back nobody and costs one
// message of memory, and one that reads no more loses the stream (see StallGuard).
#ifndef EYEBOX_SERVICE_SERVER_HANDLERS_GUARDED_STREAM_H_
#define EYEBOX_SERVICE_SERVER_HANDLERS_GUARDED_STREAM_H_

#include <grpcpp/grpcpp.h>

#include <chrono>
#include <memory>
#include <mutex>
#include <optional>

#include "service/server/handlers/stall_guard.h"

namespace eyebox::service {

// Whoever makes messages calls Advance() when there may be something new, from any thread.
template <typename Message>
class GuardedStream : public grpc::ServerWriteReactor<Message>,
                      public std::enable_shared_from_this<GuardedStream<Message>> {
 public:
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
    guard_.reset();  // whoever calls Advance() may keep this a moment longer than the call lives
    Leave();
    self_.reset();
  }

 protected:
  GuardedStream(grpc::CallbackServerContext* call, std::chrono::milliseconds stalled_after) {
    guard_.emplace(call, stalled_after);
  }

  // Until gRPC is done with the call, or Release() says that it never began.
  std::shared_ptr<GuardedStream> Hold() {
    self_ = this->shared_from_this();
    return self_;
  }
  void Release() { self_.reset(); }

  // Does the one thing that is due, if any: write the next message or finish.
  void Advance() {
    std::optional<grpc::Status> end;
    {
      const std::lock_guard lock(mutex_);
      if (writing_ || finished_ || !IsReady()) return;
      end = gone_ ? grpc::Status(grpc::StatusCode::CANCELLED, "the client went away") : EndIfDue();
      finished_ = end.has_value();
      writing_ = !finished_ && TakeNext(message_);
      if (!finished_ && !writing_) return;
    }
    if (end) return this->Finish(*end);
    guard_->WriteBegins();
    this->StartWrite(&message_);
  }

  // These three are called with the lock held, the last after the others.
  virtual bool IsReady() const { return true; }
  virtual std::optional<grpc::Status> EndIfDue() = 0;
  // False: there is nothing new. `message` is what was written last.
  virtual bool TakeNext(Message& message) = 0;
  // The call is over: nobody need call Advance() any more.
  virtual void Leave() = 0;

  std::mutex& mutex() { return mutex_; }
  const Message& message() const { return message_; }  // being written, or written last

 private:
  std::optional<StallGuard> guard_;
  std::shared_ptr<GuardedStream> self_;

  std::mutex mutex_;
  Message message_;
  bool writing_ = false;
  bool gone_ = false;
  bool finished_ = false;
};

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_SERVER_HANDLERS_GUARDED_STREAM_H_
