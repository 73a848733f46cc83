#include "service/server/jobs/stimulus_desk.h"

#include <utility>

#include "capture/base/status.h"

namespace eyebox::service {
namespace {

constexpr std::chrono::milliseconds kLook(50);  // between two looks at `cancelled`

absl::Status NotReady() {
  return absl::UnavailableError(
      Complaint("name", "the job is not ready to capture", "ask again in a moment"));
}

}  // namespace

void StimulusDesk::Open(Way way) {
  const std::lock_guard lock(mutex_);
  way_ = way;
}

template <typename Ready>
absl::Status StimulusDesk::Await(std::unique_lock<std::mutex>& lock, const Ready& ready,
                                 const std::function<bool()>& cancelled,
                                 std::chrono::milliseconds longest) {
  auto end = std::chrono::steady_clock::now() + longest;
  while (!ready()) {
    // Asked without the lock: it looks at the table, whose listeners look here.
    lock.unlock();
    const bool stop = cancelled && cancelled();
    lock.lock();
    if (stop) return absl::CancelledError("stopped while it waited for a client");
    if (std::exchange(heard_, false)) end = std::chrono::steady_clock::now() + longest;
    if (ready()) break;
    if (std::chrono::steady_clock::now() >= end) {
      return absl::DeadlineExceededError(
          Complaint("client", "said nothing for " + std::to_string(longest.count() / 1000) + " s",
                    "create another capture job for this recording_id with resume set"));
    }
    word_.wait_for(lock, kLook);
  }
  return absl::OkStatus();
}

absl::Status StimulusDesk::AwaitShown(const v1::CaptureSpec& capture,
                                      const std::string& instruction,
                                      const std::function<bool()>& cancelled,
                                      std::chrono::milliseconds longest) {
  {
    const std::lock_guard lock(mutex_);
    wanted_ = Wanted{++step_, capture, instruction};
  }
  changed_();
  std::unique_lock lock(mutex_);
  const absl::Status shown = Await(
      lock, [this] { return !wanted_; }, cancelled, longest);
  wanted_.reset();
  return shown;
}

absl::StatusOr<StimulusDesk::Order> StimulusDesk::AwaitOrder(const std::function<bool()>& cancelled,
                                                             std::chrono::milliseconds longest) {
  std::unique_lock lock(mutex_);
  EYEBOX_RETURN_IF_ERROR(Await(
      lock, [this] { return order_ || finish_; }, cancelled, longest));
  if (!order_) return Order{.finish = true, .request = {}};
  Order order{.finish = false, .request = *std::move(order_)};
  order_.reset();
  return order;
}

void StimulusDesk::Answer(const absl::StatusOr<v1::CaptureReply>& reply) {
  Done done;
  {
    const std::lock_guard lock(mutex_);
    done = std::exchange(done_, nullptr);
  }
  if (done) done(reply);
}

void StimulusDesk::Close(const absl::Status& why) {
  {
    const std::lock_guard lock(mutex_);
    if (!closed_.ok()) return;
    closed_ = why;
    wanted_.reset();
  }
  Answer(why);
}

absl::Status StimulusDesk::CheckWay(Way way) const {
  if (!closed_.ok()) return closed_;
  if (way_ == Way::kUnknown) return NotReady();
  if (way_ == way) return absl::OkStatus();
  return way == Way::kPlan
             ? Rejected("name", "the job is a session: it does not say what to show",
                        "show a stimulus and call Capture, or create the job without session")
             : Rejected("name", "the job carries out a plan: it says what to show",
                        "open RunPlan or call NextStimulus, or create the job with session");
}

absl::StatusOr<std::optional<StimulusDesk::Wanted>> StimulusDesk::ToShow() {
  const std::lock_guard lock(mutex_);
  EYEBOX_RETURN_IF_ERROR(CheckWay(Way::kPlan));
  heard_ = true;
  return wanted_;
}

absl::Status StimulusDesk::Shown(uint64_t step) {
  const std::lock_guard lock(mutex_);
  EYEBOX_RETURN_IF_ERROR(CheckWay(Way::kPlan));
  if (step > step_ || step == 0) {
    return absl::OutOfRangeError(Complaint(
        "step", std::to_string(step) + " was not asked for; the newest is " + std::to_string(step_),
        "acknowledge the step of the newest StimulusStep"));
  }
  heard_ = true;
  if (wanted_ && wanted_->step == step) wanted_.reset();  // an older one was said twice
  word_.notify_all();
  return absl::OkStatus();
}

void StimulusDesk::Place(const v1::CaptureRequest& request, Done done) {
  absl::Status refused;
  {
    const std::lock_guard lock(mutex_);
    refused = CheckWay(Way::kSession);
    if (refused.ok() && (done_ || finish_)) {
      refused = absl::UnavailableError(Complaint(
          "name", finish_ ? "the session was finished" : "another capture is being taken",
          finish_ ? "create another capture job" : "call Capture again once it has returned"));
    }
    if (refused.ok()) {
      heard_ = true;
      order_ = request;
      done_ = std::move(done);
      word_.notify_all();
    }
  }
  if (!refused.ok()) done(refused);
}

absl::Status StimulusDesk::Finish() {
  const std::lock_guard lock(mutex_);
  EYEBOX_RETURN_IF_ERROR(CheckWay(Way::kSession));
  finish_ = true;
  word_.notify_all();
  return absl::OkStatus();
}

}  // namespace eyebox::service
