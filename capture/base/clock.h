// Time is injected: tests advance a ManualClock, the service reads the kernel's clocks.
#ifndef EYEBOX_CAPTURE_BASE_CLOCK_H_
#define EYEBOX_CAPTURE_BASE_CLOCK_H_

#include <cstdint>

namespace eyebox {

// Thread-safe. Nanoseconds, so that frames and ADC samples align without rounding.
class Clock {
 public:
  virtual ~Clock() = default;
  // CLOCK_MONOTONIC: for alignment and durations; no meaning across boots.
  virtual int64_t MonotonicNs() const = 0;
  // CLOCK_REALTIME since 1970-01-01 UTC: for labels only, it may jump.
  virtual int64_t RealNs() const = 0;
};

// The process-wide clock of the operating system; never null, never freed.
const Clock* SystemClock();

// Starts at the given times; both advance together and only when told to. Not thread-safe.
class ManualClock final : public Clock {
 public:
  explicit ManualClock(int64_t monotonic_ns = 0, int64_t real_ns = 0)
      : monotonic_ns_(monotonic_ns), real_ns_(real_ns) {}
  int64_t MonotonicNs() const override { return monotonic_ns_; }
  int64_t RealNs() const override { return real_ns_; }
  void AdvanceNs(int64_t step_ns) {
    monotonic_ns_ += step_ns;
    real_ns_ += step_ns;
  }

 private:
  int64_t monotonic_ns_;
  int64_t real_ns_;
};

}  // namespace eyebox

#endif  // EYEBOX_CAPTURE_BASE_CLOCK_H_
