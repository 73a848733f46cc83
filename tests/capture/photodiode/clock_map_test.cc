#include "capture/photodiode/serial/clock_map.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "capture/base/random.h"

namespace eyebox::capture::serial {
namespace {

constexpr int64_t kMs = 1'000'000;
constexpr int64_t kS = 1'000'000'000;

TEST(MicrosUnwrapper, CountsOnOverTheWrap) {
  MicrosUnwrapper unwrap;
  EXPECT_EQ(unwrap.DeviceNs(0xfffffff0, 0), 0xfffffff0LL * 1000);
  EXPECT_EQ(unwrap.DeviceNs(0x00000010, 32000), 0x100000010LL * 1000);
}

TEST(MicrosUnwrapper, BridgesASilenceOfSeveralWraps) {
  MicrosUnwrapper unwrap;
  const int64_t wrap_ns = (int64_t{1} << 32) * 1000;
  unwrap.DeviceNs(5000, 0);
  // Three wraps and a minute of silence, on a host clock that runs 0.1 % faster.
  const int64_t later_ns = 3 * wrap_ns + 60 * kS;
  const auto micros = static_cast<uint32_t>((later_ns / 1000 + 5000) & 0xffffffff);
  EXPECT_EQ(unwrap.DeviceNs(micros, later_ns + later_ns / 1000), later_ns + 5000 * 1000);
}

TEST(MicrosUnwrapper, KeepsSmallStepsBack) {
  MicrosUnwrapper unwrap;
  unwrap.DeviceNs(1000, 10);
  EXPECT_EQ(unwrap.DeviceNs(900, 20), 900 * 1000);
  EXPECT_EQ(unwrap.DeviceNs(1100, 30), 1100 * 1000);
}

// A board whose resonator is off, behind a link that delays: what the map must see through.
struct Board {
  double slope = 1.003;        // s of CLOCK_MONOTONIC per s of the board
  int64_t start_ns = 77 * kS;  // CLOCK_MONOTONIC at its 0

  int64_t HostNs(int64_t device_ns) const {
    return start_ns + std::llround(slope * static_cast<double>(device_ns));
  }
};

// A frame each 10 ms, a round trip each 250 ms. Delays: 0.3 ms, exponential of mean 1 ms, and one
// in fifty of 30 ms more.
void Talk(const Board& board, int64_t from_ns, int64_t to_ns, RandomStream& random, ClockMap& map) {
  const auto delay_ns = [&random] {
    const double tail = random.Below(50) == 0 ? 30e6 : 0;
    return std::llround(0.3e6 - 1e6 * std::log(random.Uniform()) + tail);
  };
  for (int64_t device_ns = from_ns; device_ns < to_ns; device_ns += 10 * kMs) {
    const int64_t host_ns = board.HostNs(device_ns);
    map.AddArrival(device_ns, host_ns + delay_ns());
    if (device_ns % (250 * kMs) == 0) {
      map.AddRoundTrip(device_ns, host_ns - delay_ns(), host_ns + delay_ns());
    }
  }
}

TEST(ClockMap, FollowsABoardThatRunsWrong) {
  for (uint64_t seed = 0; seed < 20; ++seed) {
    RandomStream random({7, seed});
    const Board board = {.slope = 1 + 0.004 * (2 * random.Uniform() - 1)};
    ClockMap map;
    Talk(board, 0, 20 * kS, random, map);
    EXPECT_NEAR(map.slope(), board.slope, 5e-5);
    for (const int64_t device_ns : {19 * kS, 20 * kS}) {
      const auto mapped = map.Map(device_ns);
      ASSERT_TRUE(mapped.ok()) << mapped.status();
      const int64_t error_ns = mapped->monotonic_ns - board.HostNs(device_ns);
      EXPECT_LE(std::abs(error_ns), mapped->uncertainty_ns);
      EXPECT_LT(mapped->uncertainty_ns, kMs);
    }
  }
}

TEST(ClockMap, StatesItsUncertaintyBeforeTheSlopeIsKnown) {
  RandomStream random({8});
  const Board board = {.slope = 0.996};
  ClockMap map;
  Talk(board, 0, kS, random, map);
  EXPECT_EQ(map.slope(), 1);
  const auto mapped = map.Map(kS);
  ASSERT_TRUE(mapped.ok());
  EXPECT_LE(std::abs(mapped->monotonic_ns - board.HostNs(kS)), mapped->uncertainty_ns);
  EXPECT_GT(mapped->uncertainty_ns, 4000);
}

TEST(ClockMap, ForgetsHowTheBoardRanBefore) {
  RandomStream random({9});
  ClockMap map;
  const Board cold = {.slope = 1.004};
  Talk(cold, 0, 20 * kS, random, map);
  const Board warm = {.slope = 1.001, .start_ns = cold.start_ns + std::llround(0.003 * 20e9)};
  Talk(warm, 20 * kS, 60 * kS, random, map);
  EXPECT_NEAR(map.slope(), warm.slope, 5e-5);
  const auto mapped = map.Map(60 * kS);
  ASSERT_TRUE(mapped.ok());
  EXPECT_LE(std::abs(mapped->monotonic_ns - warm.HostNs(60 * kS)), mapped->uncertainty_ns);
}

TEST(ClockMap, ManyLateFramesDoNotMoveIt) {
  RandomStream random({10});
  const Board board;
  ClockMap map;
  Talk(board, 0, 10 * kS, random, map);
  // The host was stalled: two seconds of frames arrive together at its end.
  for (int64_t device_ns = 10 * kS; device_ns < 12 * kS; device_ns += 10 * kMs) {
    map.AddArrival(device_ns, board.HostNs(12 * kS));
  }
  const auto mapped = map.Map(12 * kS);
  ASSERT_TRUE(mapped.ok());
  EXPECT_LE(std::abs(mapped->monotonic_ns - board.HostNs(12 * kS)), mapped->uncertainty_ns);
  EXPECT_LT(mapped->uncertainty_ns, 2 * kMs);
}

TEST(ClockMap, WithoutARoundTripItKnowsNothing) {
  ClockMap map;
  map.AddArrival(0, kS);
  EXPECT_TRUE(absl::IsFailedPrecondition(map.Map(0).status()));
}

}  // namespace
}  // namespace eyebox::capture::serial
