// The conversation with the board: a thread that reads, stamps and decodes at once, whatever the
// caller is doing, so that neither the kernel's buffer overflows nor arrival times are late.
#ifndef EYEBOX_CAPTURE_PHOTODIODE_SERIAL_LINK_H_
#define EYEBOX_CAPTURE_PHOTODIODE_SERIAL_LINK_H_

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "capture/base/clock.h"
#include "capture/photodiode/serial/messages.h"
#include "capture/photodiode/serial/port.h"

namespace eyebox::capture::serial {

struct Arrival {
  Message message;
  int64_t monotonic_ns = 0;  // when the bytes that completed it had been read
};

class Link {
 public:
  // `clock` must outlive the link and be thread-safe.
  Link(std::unique_ptr<Port> port, const Clock* clock);
  ~Link();
  Link(const Link&) = delete;
  Link& operator=(const Link&) = delete;

  absl::Status Send(const Request& request);

  // The next message in order, empty after `timeout`. At most 65536 wait; older ones are dropped
  // (the sequence shows it). Errors: Unavailable (unplugged), once everything before was taken.
  absl::StatusOr<std::optional<Arrival>> Next(std::chrono::milliseconds timeout);

  uint64_t damaged_frames() const;

 private:
  void ReadUntilStopped(const std::stop_token& stop);
  void Deliver(const std::vector<Bytes>& payloads, int64_t arrival_ns, uint64_t damaged);

  const std::unique_ptr<Port> port_;
  const Clock* const clock_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Arrival> arrivals_;
  absl::Status lost_;
  uint64_t damaged_ = 0;
  std::jthread thread_;  // last: it uses everything above
};

}  // namespace eyebox::capture::serial

#endif  // EYEBOX_CAPTURE_PHOTODIODE_SERIAL_LINK_H_
