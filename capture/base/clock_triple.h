// One instant read on several clocks, so that times of one can be told on another.
#ifndef EYEBOX_CAPTURE_BASE_CLOCK_TRIPLE_H_
#define EYEBOX_CAPTURE_BASE_CLOCK_TRIPLE_H_

#include <cstdint>
#include <functional>
#include <optional>

#include "absl/status/statusor.h"
#include "capture/base/clock.h"

namespace eyebox {

// All nanoseconds. `real_ns` and `device_ns` were read between two monotonic reads that lie
// `window_ns` apart; `monotonic_ns` is their middle. Each therefore belongs to
// monotonic_ns +- window_ns / 2: a bound, not a standard deviation.
struct ClockTriple {
  int64_t monotonic_ns = 0;
  int64_t real_ns = 0;
  std::optional<int64_t> device_ns;  // empty for a device without a clock of its own
  int64_t window_ns = 0;
  friend bool operator==(const ClockTriple&, const ClockTriple&) = default;
};

// Reads the device's own clock, in ns of that clock.
using DeviceClock = std::function<absl::StatusOr<int64_t>()>;

// The narrowest of `attempts` (>= 1) tries: a try that was interrupted has a wide window.
// `read_device` may be empty. Errors: InvalidArgument (attempts), those of `read_device`.
absl::StatusOr<ClockTriple> SampleClockTriple(const Clock& clock, const DeviceClock& read_device,
                                              int attempts = 8);

// By how much the wall clock was set forward (positive) or back between two triples, ns; zero
// where the change is within what the two windows and a slew of 500 ppm (adjtime) explain.
int64_t WallClockStepNs(const ClockTriple& earlier, const ClockTriple& later);

}  // namespace eyebox

#endif  // EYEBOX_CAPTURE_BASE_CLOCK_TRIPLE_H_
