// What Prometheus may scrape: calls, jobs, disk.
#ifndef EYEBOX_SERVICE_SERVER_OBSERVE_METRICS_H_
#define EYEBOX_SERVICE_SERVER_OBSERVE_METRICS_H_

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "absl/status/status.h"
#include "absl/status/statusor.h"

namespace eyebox::service {

// Read anew at every scrape.
struct MomentaryFigures {
  int jobs_queued = 0;
  int jobs_running = 0;
  uint64_t disk_free_bytes = 0;  // of the fuller one of data and state
  bool serving = false;
};

// Thread-safe.
class Metrics {
 public:
  explicit Metrics(std::function<MomentaryFigures()> momentary);
  ~Metrics();

  // `method` is one of ours, never a client's words; `code` a canonical name.
  void CountCall(std::string_view method, std::string_view code, double seconds);

  // A call began, or is gone with all that it held.
  void CallOpened();
  void CallClosed();

  // Serves /metrics on `address`, 127.0.0.1:PORT, [::1]:PORT or localhost:PORT; gives the port.
  // Errors: InvalidArgument (not loopback), Unavailable (port taken).
  absl::StatusOr<int> Expose(std::string_view address);
  // What a scrape gives.
  std::string Text() const;

 private:
  struct Parts;
  const std::unique_ptr<Parts> parts_;
};

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_SERVER_OBSERVE_METRICS_H_
