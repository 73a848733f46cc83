#include "capture/photodiode/serial/clock_map.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "capture/base/status.h"

namespace eyebox::capture::serial {
namespace {

constexpr int64_t kWrapUs = int64_t{1} << 32;
constexpr int64_t kWindowNs = 30'000'000'000;
constexpr int64_t kBinNs = 50'000'000;
constexpr int64_t kSlopeSpanNs = 2'000'000'000;
// The ceramic resonator of an UNO is good to 0.5 %.
constexpr double kNominalSlopeBound = 0.005;
constexpr double kMicrosStepNs = 4000;

}  // namespace

int64_t MicrosUnwrapper::DeviceNs(uint32_t micros, int64_t arrival_ns) {
  int64_t us = micros;
  if (last_us_) {
    const int64_t expected_us = *last_us_ + (arrival_ns - last_arrival_ns_) / 1000;
    // The nearest to what is expected of all values that look like `micros`.
    const int64_t ahead_us = expected_us - us + kWrapUs / 2;
    us += (ahead_us >= 0 ? ahead_us / kWrapUs : -1) * kWrapUs;
  }
  if (!last_us_ || us > *last_us_) {
    last_us_ = us;
    last_arrival_ns_ = arrival_ns;
  }
  return us * 1000;
}

void ClockMap::AddArrival(int64_t device_ns, int64_t arrival_ns) {
  fit_.reset();
  Forget(device_ns);
  const auto delay_ns = [](const Point& point) { return point.host_ns - point.device_ns; };
  const Point point = {device_ns, arrival_ns};
  if (arrivals_.empty() || device_ns / kBinNs > arrivals_.back().device_ns / kBinNs) {
    arrivals_.push_back(point);
  } else if (device_ns / kBinNs == arrivals_.back().device_ns / kBinNs &&
             delay_ns(point) < delay_ns(arrivals_.back())) {
    arrivals_.back() = point;
  }
}

void ClockMap::AddRoundTrip(int64_t device_ns, int64_t sent_ns, int64_t arrival_ns) {
  AddArrival(device_ns, arrival_ns);
  sent_.push_back({device_ns, sent_ns});
}

void ClockMap::Forget(int64_t device_ns) {
  const auto forget = [device_ns](std::deque<Point>& points, size_t keep) {
    while (points.size() > keep && points.front().device_ns < device_ns - kWindowNs) {
      points.pop_front();
    }
  };
  forget(arrivals_, 0);
  forget(sent_, 1);  // an old lower bound is better than none
}

// The edge of the lower convex hull over the middle of the window: of all lines below every
// arrival the one that is nearest to them on the whole.
void ClockMap::EstimateSlope(Fit& fit) const {
  fit.slope_bound = kNominalSlopeBound;
  const int64_t span_ns = arrivals_.back().device_ns - arrivals_.front().device_ns;
  if (span_ns < kSlopeSpanNs) return;
  const auto x = [&fit](const Point& p) { return double(p.device_ns - fit.origin.device_ns); };
  const auto y = [&fit, x](const Point& p) {
    return double(p.host_ns - fit.origin.host_ns) - x(p);
  };
  std::vector<Point> hull;
  for (const Point& point : arrivals_) {
    while (hull.size() > 1) {
      const Point& a = hull[hull.size() - 2];
      const Point& b = hull.back();
      if ((y(b) - y(a)) * (x(point) - x(a)) < (y(point) - y(a)) * (x(b) - x(a))) break;
      hull.pop_back();
    }
    hull.push_back(point);
  }
  const double middle = (x(arrivals_.front()) + x(arrivals_.back())) / 2;
  size_t edge = 1;
  while (edge + 1 < hull.size() && x(hull[edge]) < middle) ++edge;
  const Point& a = hull[edge - 1];
  const Point& b = hull[edge];
  const double skew = (y(b) - y(a)) / (x(b) - x(a));
  if (std::abs(skew) > 2 * kNominalSlopeBound) return;  // no resonator does that: a stalled host
  fit.slope = 1 + skew;
  fit.slope_bound = kMicrosStepNs / static_cast<double>(span_ns);
}

const ClockMap::Fit& ClockMap::Fitted() const {
  if (fit_) return *fit_;
  Fit fit;
  if (arrivals_.empty()) return fit_.emplace(fit);
  fit.origin = arrivals_.back();
  EstimateSlope(fit);
  const auto offset_ns = [&fit](const Point& point) {
    return static_cast<double>(point.host_ns - fit.origin.host_ns) -
           fit.slope * static_cast<double>(point.device_ns - fit.origin.device_ns);
  };
  const auto age_ns = [&fit](const Point& point) {
    return fit.slope_bound * std::abs(double(point.device_ns - fit.origin.device_ns));
  };
  fit.upper_ns = std::numeric_limits<double>::max();
  fit.lower_ns = std::numeric_limits<double>::lowest();
  // Old bounds are widened by what the slope may have done since.
  for (const Point& p : arrivals_) fit.upper_ns = std::min(fit.upper_ns, offset_ns(p) + age_ns(p));
  for (const Point& p : sent_) fit.lower_ns = std::max(fit.lower_ns, offset_ns(p) - age_ns(p));
  return fit_.emplace(fit);
}

absl::StatusOr<ClockMap::Mapped> ClockMap::Map(int64_t device_ns) const {
  if (sent_.empty()) {
    return Rejected("serial photodiode", "its clock was not compared with ours yet",
                    "send a request and wait for the answer");
  }
  const Fit& fit = Fitted();
  const auto since_ns = static_cast<double>(device_ns - fit.origin.device_ns);
  const double offset_ns = (fit.upper_ns + fit.lower_ns) / 2;
  // Bounds that contradict each other by some microseconds mean a slope that changed: their
  // distance is then what is not known.
  const double uncertainty_ns = std::abs(fit.upper_ns - fit.lower_ns) / 2 +
                                fit.slope_bound * std::abs(since_ns) + kMicrosStepNs;
  return Mapped{.monotonic_ns = fit.origin.host_ns + std::llround(fit.slope * since_ns + offset_ns),
                .uncertainty_ns = std::llround(std::ceil(uncertainty_ns))};
}

}  // namespace eyebox::capture::serial
