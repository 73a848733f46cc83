#include "fit/cube/chain.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace eyebox::fit {
namespace {

using ::testing::ElementsAre;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Entries that follow (x + 1)^2 over `intervals` unit intervals within `tolerance`.
ChainProblem SquareWithin(double tolerance, int intervals) {
  ChainProblem problem;
  for (int i = 0; i < intervals; ++i) {
    std::vector<MixBound> bounds;
    for (int k = 0; k <= 32; ++k) {
      const double wanted = std::pow(1 + i + k / 32.0, 2);
      bounds.push_back({k / 32.0, wanted - tolerance, wanted + tolerance});
    }
    problem.intervals.push_back(bounds);
  }
  for (int i = 0; i <= intervals; ++i) {
    problem.cap.push_back(100);
    problem.preferred.push_back((i + 1) * (i + 1));
  }
  return problem;
}

// A chord of the parabola over a unit interval lies at most 1/4 above it; lowered by half of that,
// 1/8 is the best that straight pieces can do.
TEST(ChainTest, ParabolaIsMetAtOneEighthAndNotBelow) {
  for (int intervals : {1, 2, 7}) {
    EXPECT_TRUE(SolveChain(SquareWithin(0.125 + 1e-9, intervals)));
    EXPECT_FALSE(SolveChain(SquareWithin(0.125 - 1e-9, intervals)));
  }
}

TEST(ChainTest, SolutionMeetsEveryBoundAndRises) {
  const ChainProblem problem = SquareWithin(0.13, 7);
  const auto entries = SolveChain(problem);
  ASSERT_TRUE(entries);
  for (size_t i = 0; i < problem.intervals.size(); ++i) {
    EXPECT_LE((*entries)[i], (*entries)[i + 1]);
    for (const MixBound& bound : problem.intervals[i]) {
      const double mix = (1 - bound.weight) * (*entries)[i] + bound.weight * (*entries)[i + 1];
      EXPECT_GE(mix, bound.low - 1e-12);
      EXPECT_LE(mix, bound.high + 1e-12);
    }
  }
}

TEST(ChainTest, PreferredEntriesAreTakenWhereTheyAreAllowed) {
  EXPECT_THAT(*SolveChain(SquareWithin(0.3, 3)), ElementsAre(1, 4, 9, 16));
}

TEST(ChainTest, FallingBoundsAreRefused) {
  ChainProblem problem{{{{0, 2, 3}, {1, 0, 1}}}, {10, 10}, {2, 1}};
  EXPECT_FALSE(SolveChain(problem));
}

TEST(ChainTest, CapIsKept) {
  ChainProblem problem{{{{0.5, 2, kInfinity}}}, {1, 10}, {0, 100}};
  const auto entries = SolveChain(problem);
  ASSERT_TRUE(entries);
  EXPECT_EQ((*entries)[1], 10);
  problem.cap = {1, 2};
  EXPECT_FALSE(SolveChain(problem));
}

TEST(ChainTest, OpenBoundsLeaveThePreference) {
  ChainProblem problem{{{}, {{0.5, 0, kInfinity}}}, {1, 1, 1}, {0.2, 0.3, 0.9}};
  EXPECT_THAT(*SolveChain(problem), ElementsAre(0.2, 0.3, 0.9));
}

}  // namespace
}  // namespace eyebox::fit
