#include "capture/base/clock_triple.h"

#include <gtest/gtest.h>

#include <vector>

namespace eyebox {
namespace {

// Every read takes the next of these steps.
class SteppingClock final : public Clock {
 public:
  explicit SteppingClock(std::vector<int64_t> steps_ns) : steps_ns_(std::move(steps_ns)) {}
  int64_t MonotonicNs() const override {
    now_ns_ += steps_ns_[next_++ % steps_ns_.size()];
    return now_ns_;
  }
  int64_t RealNs() const override { return MonotonicNs() + 1'000'000; }

 private:
  const std::vector<int64_t> steps_ns_;
  mutable size_t next_ = 0;
  mutable int64_t now_ns_ = 0;
};

TEST(ClockTriple, KeepsTheNarrowestOfItsTries) {
  // Three reads a try: the second try is the one that nothing interrupted.
  const SteppingClock clock({10, 500, 500, 10, 20, 30, 10, 80, 900});
  const auto triple = SampleClockTriple(clock, nullptr, 3);
  ASSERT_TRUE(triple.ok()) << triple.status();
  EXPECT_EQ(triple->window_ns, 50);
  EXPECT_EQ(triple->monotonic_ns, 1020 + 25);
  EXPECT_EQ(triple->real_ns, 1020 + 20 + 1'000'000);
  EXPECT_FALSE(triple->device_ns.has_value());
}

TEST(ClockTriple, ReadsTheDeviceBetweenTheTwoMonotonicReads) {
  const ManualClock clock(100, 5000);
  const auto triple = SampleClockTriple(clock, [] { return int64_t{42}; });
  ASSERT_TRUE(triple.ok()) << triple.status();
  EXPECT_EQ(triple->device_ns, 42);
  EXPECT_EQ(triple->window_ns, 0);
}

TEST(ClockTriple, PassesOnThatTheDeviceCannotBeRead) {
  const ManualClock clock;
  const auto lost = [] { return absl::UnavailableError("gone"); };
  EXPECT_TRUE(absl::IsUnavailable(SampleClockTriple(clock, lost).status()));
}

TEST(ClockTriple, NoAttemptIsRefused) {
  EXPECT_TRUE(absl::IsInvalidArgument(SampleClockTriple(ManualClock(), nullptr, 0).status()));
}

TEST(ClockTriple, OfTheKernelIsOrdered) {
  const int64_t before_ns = SystemClock()->MonotonicNs();
  const auto triple = SampleClockTriple(*SystemClock(), nullptr);
  ASSERT_TRUE(triple.ok());
  EXPECT_GE(triple->monotonic_ns, before_ns);
  EXPECT_LE(triple->monotonic_ns, SystemClock()->MonotonicNs());
  EXPECT_GE(triple->window_ns, 0);
}

TEST(WallClockStep, IsFoundInBothDirections) {
  const ClockTriple earlier = {.monotonic_ns = 0, .real_ns = 0, .device_ns = {}, .window_ns = 100};
  ClockTriple later = {.monotonic_ns = 1'000'000'000,
                       .real_ns = 4'600'000'000'000,
                       .device_ns = {},
                       .window_ns = 100};
  EXPECT_EQ(WallClockStepNs(earlier, later), 4'599'000'000'000);
  later.real_ns = -1'000'000'000;
  EXPECT_EQ(WallClockStepNs(earlier, later), -2'000'000'000);
}

TEST(WallClockStep, IsNotSeenInReadingErrorAndSlew) {
  const ClockTriple earlier = {.monotonic_ns = 0, .real_ns = 0, .device_ns = {}, .window_ns = 100};
  const ClockTriple later = {.monotonic_ns = 1'000'000'000,
                             .real_ns = 1'000'500'090,  // 500 us slewed, 90 ns misread
                             .device_ns = {},
                             .window_ns = 100};
  EXPECT_EQ(WallClockStepNs(earlier, later), 0);
}

}  // namespace
}  // namespace eyebox
