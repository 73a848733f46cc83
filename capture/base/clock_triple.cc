#include "capture/base/clock_triple.h"

#include <cstdlib>
#include <string>

#include "capture/base/status.h"

namespace eyebox {
namespace {

constexpr int64_t kSlewPerMillion = 500;

absl::StatusOr<ClockTriple> SampleOnce(const Clock& clock, const DeviceClock& read_device) {
  ClockTriple triple;
  const int64_t before_ns = clock.MonotonicNs();
  triple.real_ns = clock.RealNs();
  if (read_device) {
    EYEBOX_ASSIGN_OR_RETURN(triple.device_ns, read_device());
  }
  triple.window_ns = clock.MonotonicNs() - before_ns;
  triple.monotonic_ns = before_ns + triple.window_ns / 2;
  return triple;
}

}  // namespace

absl::StatusOr<ClockTriple> SampleClockTriple(const Clock& clock, const DeviceClock& read_device,
                                              int attempts) {
  if (attempts < 1) {
    return BadInput("clock triple", "is to be read " + std::to_string(attempts) + " times",
                    "allow one attempt or more");
  }
  EYEBOX_ASSIGN_OR_RETURN(ClockTriple best, SampleOnce(clock, read_device));
  for (int i = 1; i < attempts; ++i) {
    EYEBOX_ASSIGN_OR_RETURN(const ClockTriple triple, SampleOnce(clock, read_device));
    if (triple.window_ns < best.window_ns) best = triple;
  }
  return best;
}

int64_t WallClockStepNs(const ClockTriple& earlier, const ClockTriple& later) {
  const int64_t elapsed_ns = later.monotonic_ns - earlier.monotonic_ns;
  const int64_t step_ns = (later.real_ns - earlier.real_ns) - elapsed_ns;
  const int64_t explained_ns = (earlier.window_ns + later.window_ns + 1) / 2 +
                               std::abs(elapsed_ns) / 1'000'000 * kSlewPerMillion;
  return std::abs(step_ns) <= explained_ns ? 0 : step_ns;
}

}  // namespace eyebox
