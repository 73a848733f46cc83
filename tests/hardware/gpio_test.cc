// Our pulses and edges against the kernel's gpio-sim. Run by tests/hardware/run in the guest; it is
// skipped where there is no gpio-sim.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <thread>

#include "capture/trigger/match_edges.h"
#include "capture/trigger/trigger.h"
#include "tests/hardware/gpio_sim.h"

namespace eyebox::capture {
namespace {

using std::chrono::milliseconds;
using testing::HasSubstr;

// STROBE is pulled by the test, as a camera's strobe output would pull it.
class Gpio : public testing::Test {
 protected:
  void SetUp() override {
    if (!GpioSim::IsAvailable()) GTEST_SKIP() << "no gpio-sim here: run tests/hardware/run";
    sim_.emplace("eyebox-test", 1, "STROBE");
    chip_ = sim_->chip();
  }

  void Pull(int line, bool up) { sim_->Pull(line, up); }
  std::string Value(int line) const { return sim_->Value(line); }

  std::optional<GpioSim> sim_;
  std::string chip_;
};

TEST_F(Gpio, APulseIsHighForItsWidthAndLowAfterwards) {
  auto trigger = OpenTrigger(chip_ + ":0", SystemClock());
  ASSERT_TRUE(trigger.ok()) << trigger.status();
  EXPECT_EQ(Value(0), "0");
  std::string during;
  std::thread looker([&] {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    while (during != "1" && std::chrono::steady_clock::now() < end) during = Value(0);
  });
  const auto pulse = (*trigger)->Fire(milliseconds(500));
  looker.join();
  ASSERT_TRUE(pulse.ok()) << pulse.status();
  EXPECT_EQ(during, "1");
  EXPECT_EQ(Value(0), "0");
  EXPECT_GE(pulse->off.before_ns - pulse->on.after_ns, 500'000'000);
}

TEST_F(Gpio, AnActiveLowPulseIsLow) {
  auto trigger = OpenTrigger(chip_ + ":0", SystemClock(), true);
  ASSERT_TRUE(trigger.ok()) << trigger.status();
  EXPECT_EQ(Value(0), "1");
}

TEST_F(Gpio, EdgesCarryMonotonicTimeAndMatchWhatCausedThem) {
  auto source = OpenEdgeSource(chip_ + ":STROBE", EdgeKind::kRising, SystemClock());
  ASSERT_TRUE(source.ok()) << source.status();
  std::vector<int64_t> caused_ns;
  std::vector<int64_t> edges_ns;
  for (int i = 0; i < 20; ++i) {
    caused_ns.push_back(SystemClock()->MonotonicNs());
    Pull(1, true);
    Pull(1, false);
    std::this_thread::sleep_for(milliseconds(100));
  }
  while (edges_ns.size() < caused_ns.size()) {
    const auto taken = (*source)->Take(milliseconds(5000));
    ASSERT_TRUE(taken.ok()) << taken.status();
    ASSERT_FALSE(taken->edges.empty()) << "after " << edges_ns.size();
    for (const Edge& edge : taken->edges) edges_ns.push_back(edge.monotonic_ns);
  }
  const auto match = MatchEdges(caused_ns, edges_ns, {.earliest_ns = 0, .latest_ns = 99'000'000});
  ASSERT_TRUE(match.ok()) << match.status();
  EXPECT_TRUE(CheckComplete(*match, "strobe").ok()) << CheckComplete(*match, "strobe");
}

TEST_F(Gpio, BothDirectionsAlternate) {
  auto source = OpenEdgeSource(chip_ + ":1", EdgeKind::kBoth, SystemClock());
  ASSERT_TRUE(source.ok()) << source.status();
  std::vector<Edge> edges;
  for (int i = 0; i < 5; ++i) {
    Pull(1, true);
    Pull(1, false);
  }
  while (edges.size() < 10) {
    const auto taken = (*source)->Take(milliseconds(5000));
    ASSERT_TRUE(taken.ok()) << taken.status();
    ASSERT_FALSE(taken->edges.empty());
    EXPECT_EQ(taken->known_losses, 0);
    edges.insert(edges.end(), taken->edges.begin(), taken->edges.end());
  }
  for (size_t i = 0; i < edges.size(); ++i) EXPECT_EQ(edges[i].rising, i % 2 == 0);
}

TEST_F(Gpio, ALineThatIsInUseIsRefused) {
  auto first = OpenTrigger(chip_ + ":2", SystemClock());
  ASSERT_TRUE(first.ok()) << first.status();
  const auto second = OpenTrigger(chip_ + ":2", SystemClock());
  EXPECT_TRUE(absl::IsUnavailable(second.status()));
  EXPECT_THAT(second.status().message(), HasSubstr("gpioinfo"));
}

TEST_F(Gpio, ALineThatIsNotThereIsNamed) {
  EXPECT_TRUE(absl::IsNotFound(OpenTrigger(chip_ + ":99", SystemClock()).status()));
  EXPECT_TRUE(absl::IsNotFound(OpenTrigger(chip_ + ":NOBODY", SystemClock()).status()));
}

}  // namespace
}  // namespace eyebox::capture
