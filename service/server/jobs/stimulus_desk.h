// Where a capture job and its clients meet: what is to be shown, what was shown, what to capture.
#ifndef EYEBOX_SERVICE_SERVER_JOBS_STIMULUS_DESK_H_
#define EYEBOX_SERVICE_SERVER_JOBS_STIMULUS_DESK_H_

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "eyebox/v1/capture_service.pb.h"

namespace eyebox::service {

// Thread-safe. The job's thread waits here; calls of clients never wait.
class StimulusDesk {
 public:
  enum class Way { kUnknown, kPlan, kSession };
  struct Wanted {
    uint64_t step = 0;
    v1::CaptureSpec capture;
    std::string instruction;
  };
  struct Order {
    bool finish = false;
    v1::CaptureRequest request;
  };
  using Done = std::function<void(const absl::StatusOr<v1::CaptureReply>&)>;

  // `changed` is called after there is something new to show. `first_step` lies above every step
  // of earlier attempts of the job.
  StimulusDesk(uint64_t first_step, std::function<void()> changed)
      : changed_(std::move(changed)), step_(first_step) {}
  ~StimulusDesk() { Close(absl::UnavailableError("the job ended")); }

  // The job's side. Errors of both waits: Cancelled (looked at several times a second),
  // DeadlineExceeded (no word of a client for so long).
  void Open(Way way);
  absl::Status AwaitShown(const v1::CaptureSpec& capture, const std::string& instruction,
                          const std::function<bool()>& cancelled,
                          std::chrono::milliseconds longest);
  absl::StatusOr<Order> AwaitOrder(const std::function<bool()>& cancelled,
                                   std::chrono::milliseconds longest);
  // To the order that was taken last.
  void Answer(const absl::StatusOr<v1::CaptureReply>& reply);
  // Whoever waits for an answer gets `why`, also if it asks later.
  void Close(const absl::Status& why);

  // The clients' side. Errors: Unavailable (the job is not ready or ends), FailedPrecondition (it
  // captures the other way round).
  absl::StatusOr<std::optional<Wanted>> ToShow();
  absl::Status Shown(uint64_t step);  // also OutOfRange
  // `done` is called once, from any thread. Orders are taken one after the other.
  void Place(const v1::CaptureRequest& request, Done done);
  absl::Status Finish();

 private:
  absl::Status CheckWay(Way way) const;
  template <typename Ready>
  absl::Status Await(std::unique_lock<std::mutex>& lock, const Ready& ready,
                     const std::function<bool()>& cancelled, std::chrono::milliseconds longest);

  const std::function<void()> changed_;
  std::mutex mutex_;
  std::condition_variable word_;
  Way way_ = Way::kUnknown;
  absl::Status closed_;
  bool heard_ = false;  // a client spoke since the wait began
  uint64_t step_ = 0;   // newest that was asked for
  std::optional<Wanted> wanted_;
  bool finish_ = false;
  std::optional<v1::CaptureRequest> order_;
  Done done_;  // of the order, until it is answered
};

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_SERVER_JOBS_STIMULUS_DESK_H_
