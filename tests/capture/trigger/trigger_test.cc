#include "capture/trigger/trigger.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "capture/trigger/line_trigger.h"
#include "capture/trigger/match_edges.h"

namespace eyebox::capture {
namespace {

using std::chrono::microseconds;
using std::chrono::seconds;
using testing::HasSubstr;

TEST(SimTrigger, EveryPulseIsSeenAtTheOtherEndOfTheWire) {
  auto source = OpenEdgeSource("sim:wire-a", EdgeKind::kRising, SystemClock());
  auto trigger = OpenTrigger("sim:wire-a", SystemClock());
  ASSERT_TRUE(source.ok() && trigger.ok()) << source.status() << trigger.status();
  std::vector<int64_t> pulses_ns;
  std::vector<int64_t> edges_ns;
  for (uint64_t i = 0; i < 50; ++i) {
    const auto pulse = (*trigger)->Fire(microseconds(100));
    ASSERT_TRUE(pulse.ok()) << pulse.status();
    EXPECT_EQ(pulse->number, i);
    EXPECT_LE(pulse->on.before_ns, pulse->on.after_ns);
    EXPECT_GE(pulse->off.before_ns - pulse->on.after_ns, 100'000);
    pulses_ns.push_back(pulse->on.before_ns);
  }
  while (edges_ns.size() < pulses_ns.size()) {
    const auto taken = (*source)->Take(seconds(20));
    ASSERT_TRUE(taken.ok()) << taken.status();
    ASSERT_FALSE(taken->edges.empty());
    for (const Edge& edge : taken->edges) edges_ns.push_back(edge.monotonic_ns);
  }
  const auto match = MatchEdges(pulses_ns, edges_ns, {.earliest_ns = 0, .latest_ns = 90'000});
  ASSERT_TRUE(match.ok()) << match.status();
  EXPECT_EQ(edges_ns.size(), 50);
}

TEST(SimTrigger, OtherWiresStaySilent) {
  auto source = OpenEdgeSource("sim:wire-b", EdgeKind::kBoth, SystemClock());
  auto trigger = OpenTrigger("sim:wire-c", SystemClock());
  ASSERT_TRUE(source.ok() && trigger.ok());
  ASSERT_TRUE((*trigger)->Fire(microseconds(1)).ok());
  EXPECT_TRUE((*source)->Take(std::chrono::milliseconds(5))->edges.empty());
}

TEST(Trigger, WidthOutsideItsLimitsIsRefused) {
  auto trigger = OpenTrigger("sim:wire-d", SystemClock());
  ASSERT_TRUE(trigger.ok());
  EXPECT_TRUE(absl::IsInvalidArgument((*trigger)->Fire(microseconds(0)).status()));
  EXPECT_TRUE(absl::IsInvalidArgument((*trigger)->Fire(seconds(2)).status()));
}

class DeadLine final : public OutputLine {
 public:
  absl::Status Set(bool) override { return absl::UnavailableError("unplugged"); }
};

TEST(Trigger, ALineThatFailsFailsThePulse) {
  const auto trigger = MakeLineTrigger("gpiochip0:1", std::make_unique<DeadLine>(), SystemClock());
  EXPECT_TRUE(absl::IsUnavailable(trigger->Fire(microseconds(1)).status()));
}

TEST(TriggerUri, NamesChipAndLine) {
  const auto address = ParseLineUri("gpiochip2:RELAY_A");
  ASSERT_TRUE(address.ok());
  EXPECT_EQ(address->chip, "gpiochip2");
  EXPECT_EQ(address->line, "RELAY_A");
}

TEST(TriggerUri, AnythingElseIsRefused) {
  for (const char* const uri : {"", "gpiochip0", "gpiochip0:", ":3", "usb:1"}) {
    EXPECT_TRUE(absl::IsInvalidArgument(OpenTrigger(uri, SystemClock()).status())) << uri;
  }
}

TEST(TriggerUri, AChipThatIsNotThereIsNamed) {
  const auto trigger = OpenTrigger("gpiochip981:0", SystemClock());
  EXPECT_TRUE(absl::IsNotFound(trigger.status())) << trigger.status();
  EXPECT_THAT(trigger.status().message(), HasSubstr("gpiochip981"));
}

}  // namespace
}  // namespace eyebox::capture
