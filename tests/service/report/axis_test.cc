#include "service/report/axis.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace eyebox::service::report {
namespace {

using ::testing::ElementsAre;

std::vector<std::string> LabelsOf(const std::vector<Tick>& ticks) {
  std::vector<std::string> labels;
  for (const Tick& tick : ticks) labels.push_back(tick.label);
  return labels;
}

TEST(AxisTest, TicksAreRoundNumbersInsideTheRange) {
  EXPECT_THAT(LabelsOf(LinearTicks({0, 1}, 5)),
              ElementsAre("0.0", "0.2", "0.4", "0.6", "0.8", "1.0"));
  EXPECT_THAT(LabelsOf(LinearTicks({-0.013, 0.011}, 5)),
              ElementsAre("−0.010", "−0.005", "0.000", "0.005", "0.010"));
}

TEST(AxisTest, FewDecadesAreLabelledAtTwoAndFiveToo) {
  const auto ticks = LogarithmicTicks({0.2, 60});
  std::vector<std::string> labelled;
  for (const Tick& tick : ticks) {
    if (!tick.label.empty()) labelled.push_back(tick.label);
  }
  EXPECT_THAT(labelled, ElementsAre("0.2", "0.5", "1", "2", "5", "10", "20", "50"));
}

TEST(AxisTest, PositionRunsFromEndToEnd) {
  const Axis linear = LinearAxis({2, 4}, 100, 300);
  EXPECT_DOUBLE_EQ(linear.Position(2), 100);
  EXPECT_DOUBLE_EQ(linear.Position(3.5), 250);
  const Axis logarithmic = LogarithmicAxis({1, 100}, 300, 100);
  EXPECT_DOUBLE_EQ(logarithmic.Position(1), 300);
  EXPECT_DOUBLE_EQ(logarithmic.Position(10), 200);
}

TEST(AxisTest, AConstantIsWidenedToARange) {
  const Range range = Widened({5, 5}, 0.05);
  EXPECT_LT(range.minimum, 5);
  EXPECT_GT(range.maximum, 5);
  const Range zero = Widened({0, 0}, 0.05);
  EXPECT_LT(zero.minimum, zero.maximum);
}

}  // namespace
}  // namespace eyebox::service::report
