// From the board's clock to CLOCK_MONOTONIC.
//
// A message arrives after it was sent, never before, and by a delay that is mostly small: arrival
// minus device time therefore lies above the true offset, and its lower envelope follows it. The
// slope of the envelope is that of the convex hull (one-way skew estimation after Moon, Skelly &
// Towsley 1999); what is constant in the delay it cannot see. Round trips bound the offset from
// below: the board cannot have read a request before it was sent. The mapping is the middle of the
// two bounds and its uncertainty half their distance.
#ifndef EYEBOX_CAPTURE_PHOTODIODE_SERIAL_CLOCK_MAP_H_
#define EYEBOX_CAPTURE_PHOTODIODE_SERIAL_CLOCK_MAP_H_

#include <cstdint>
#include <deque>
#include <optional>

#include "absl/status/statusor.h"

namespace eyebox::capture::serial {

// Times of a 32-bit microsecond counter without its wraps. A silence longer than one wrap is
// bridged by the time that passed here.
class MicrosUnwrapper {
 public:
  // Device time in ns since the first call's wrap. Small steps back (a message that overtook
  // another) are kept as they are.
  int64_t DeviceNs(uint32_t micros, int64_t arrival_ns);

 private:
  std::optional<int64_t> last_us_;
  int64_t last_arrival_ns_ = 0;
};

// Not thread-safe. Keeps the last 30 s.
class ClockMap {
 public:
  // The board's clock showed `device_ns` at some time before `arrival_ns` (CLOCK_MONOTONIC).
  void AddArrival(int64_t device_ns, int64_t arrival_ns);
  // It showed `device_ns` between `sent_ns` and `arrival_ns`.
  void AddRoundTrip(int64_t device_ns, int64_t sent_ns, int64_t arrival_ns);

  struct Mapped {
    int64_t monotonic_ns = 0;
    int64_t uncertainty_ns = 0;  // bound, from the two bounds, the slope and the 4 us of micros()
  };
  // Errors: FailedPrecondition (no round trip yet).
  absl::StatusOr<Mapped> Map(int64_t device_ns) const;

  // Seconds of CLOCK_MONOTONIC per second of the board; 1 until 2 s have been seen.
  double slope() const { return Fitted().slope; }

 private:
  struct Point {
    int64_t device_ns;
    int64_t host_ns;
  };
  struct Fit {
    Point origin = {0, 0};
    double slope = 1;
    double slope_bound = 0;  // of the error of the slope
    double upper_ns = 0;     // offset at the origin, from above and from below
    double lower_ns = 0;
  };
  void Forget(int64_t device_ns);
  const Fit& Fitted() const;
  void EstimateSlope(Fit& fit) const;

  std::deque<Point> arrivals_;  // the lowest of each 50 ms
  std::deque<Point> sent_;      // not later than the device time
  mutable std::optional<Fit> fit_;
};

}  // namespace eyebox::capture::serial

#endif  // EYEBOX_CAPTURE_PHOTODIODE_SERIAL_CLOCK_MAP_H_
