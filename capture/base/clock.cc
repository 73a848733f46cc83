#include "capture/base/clock.h"

#include <ctime>

namespace eyebox {
namespace {

int64_t ReadNs(clockid_t id) {
  timespec now{};
  clock_gettime(id, &now);
  return int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}

class KernelClock final : public Clock {
 public:
  int64_t MonotonicNs() const override { return ReadNs(CLOCK_MONOTONIC); }
  int64_t RealNs() const override { return ReadNs(CLOCK_REALTIME); }
};

}  // namespace

const Clock* SystemClock() {
  static const KernelClock clock;
  return &clock;
}

}  // namespace eyebox
