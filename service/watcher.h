// How long work tells where it is and learns that it should stop.
#ifndef EYEBOX_SERVICE_WATCHER_H_
#define EYEBOX_SERVICE_WATCHER_H_

#include <functional>
#include <string>

#include "absl/status/status.h"

namespace eyebox::service {

struct Progress {
  double fraction = 0;  // 0 to 1, never falls
  std::string step;     // in words, for a person
};

// Called from the thread that computes. `progress` and `cancelled` may be empty. `cancelled` is
// asked between captures and steps; true ends the work with Cancelled.
struct Watcher {
  std::function<void(const Progress&)> progress;
  std::function<bool()> cancelled;

  // Reports, and returns Cancelled if that was asked for.
  absl::Status Reach(double fraction, const std::string& step) const {
    if (cancelled && cancelled()) return absl::CancelledError("stopped before: " + step);
    if (progress) progress({fraction, step});
    return absl::OkStatus();
  }
  // A watcher whose 0 to 1 is `from` to `to` here. Refers to nothing but copies.
  Watcher Part(double from, double to) const {
    if (!progress) return *this;
    const auto whole = progress;
    return {[whole, from, to](const Progress& part) {
              whole({from + (to - from) * part.fraction, part.step});
            },
            cancelled};
  }
};

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_WATCHER_H_
