// The adaptive procedure against the worked examples of JCGM 101:2008.
#include "fit/budget/monte_carlo.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace eyebox::fit {
namespace {

// Mean 0, standard deviation 1, rectangular.
double DrawRectangular(RandomStream& random) { return std::sqrt(12.0) * (random.Uniform() - 0.5); }

MonteCarloFigure PropagateOne(const Trial& trial, const MonteCarloOptions& options) {
  const auto result = Propagate(1, trial, options);
  EXPECT_TRUE(result.ok()) << result.status();
  EXPECT_TRUE(result->stable);
  return result->figures[0];
}

// 7.9.2: 100 g with 0.000 35 g to two digits and to one, 2 K to one.
TEST(NumericalToleranceTest, IsHalfAUnitOfTheLastDigitThatCounts) {
  EXPECT_DOUBLE_EQ(NumericalTolerance(0.00035, 2), 0.5e-5);
  EXPECT_DOUBLE_EQ(NumericalTolerance(0.00035, 1), 0.5e-4);
  EXPECT_DOUBLE_EQ(NumericalTolerance(2, 1), 0.5);
  EXPECT_DOUBLE_EQ(NumericalTolerance(9.96, 2), 0.5);  // rounds to 10
}

// 9.2.2: u 2.0, interval -3.92 to 3.92.
TEST(MonteCarloTest, SumOfFourNormalsIsNormal) {
  const MonteCarloFigure sum = PropagateOne(
      [](RandomStream& random, std::span<double> y) {
        y[0] = DrawNormal(random) + DrawNormal(random) + DrawNormal(random) + DrawNormal(random);
        return true;
      },
      {.digits = 2, .tolerance_share = 0.4});
  EXPECT_NEAR(sum.mean, 0, 0.03);
  EXPECT_NEAR(sum.sigma, 2, 0.03);
  EXPECT_NEAR(sum.low, -3.92, 0.05);
  EXPECT_NEAR(sum.high, 3.92, 0.05);
}

// 9.2.3: the interval is -3.88 to 3.88, that of a normal distribution -3.92 to 3.92.
TEST(MonteCarloTest, SumOfFourRectanglesIsShorterThanANormal) {
  const MonteCarloFigure sum = PropagateOne(
      [](RandomStream& random, std::span<double> y) {
        y[0] = DrawRectangular(random) + DrawRectangular(random) + DrawRectangular(random) +
               DrawRectangular(random);
        return true;
      },
      {.digits = 2, .tolerance_share = 0.4});
  EXPECT_NEAR(sum.sigma, 2, 0.01);
  EXPECT_NEAR(sum.high, 3.88, 0.02);
}

// 9.2.4: one rectangle of ten times the width. u is 10.1, the interval -17.0 to 17.0, where linear
// propagation says 19.9.
TEST(MonteCarloTest, ADominantRectangleIsNotNormal) {
  const MonteCarloFigure sum = PropagateOne(
      [](RandomStream& random, std::span<double> y) {
        y[0] = DrawRectangular(random) + DrawRectangular(random) + DrawRectangular(random) +
               10 * DrawRectangular(random);
        return true;
      },
      {.digits = 2});
  EXPECT_NEAR(sum.sigma, 10.1, 0.1);
  EXPECT_NEAR(sum.low, -17.0, 0.2);
  EXPECT_NEAR(sum.high, 17.0, 0.2);
}

TEST(MonteCarloTest, TheSameSeedGivesTheSameFigures) {
  const auto draw = [](uint64_t seed) {
    return PropagateOne(
               [](RandomStream& random, std::span<double> y) {
                 y[0] = std::exp(DrawNormal(random));
                 return true;
               },
               {.seed = seed})
        .mean;
  };
  EXPECT_EQ(draw(1), draw(1));
  EXPECT_NE(draw(1), draw(2));
}

TEST(MonteCarloTest, TooFewTrialsAreNotCalledStable) {
  const auto result = Propagate(1,
                                [](RandomStream& random, std::span<double> y) {
                                  y[0] = DrawNormal(random);
                                  return true;
                                },
                                {.digits = 4, .most_trials = 30000});
  ASSERT_TRUE(result.ok());
  EXPECT_FALSE(result->stable);
  EXPECT_EQ(result->trials, 30000u);
}

TEST(MonteCarloTest, TrialsWithoutAResultAreCountedAndManyAreAnError) {
  const auto failing = [](double share) {
    return [share](RandomStream& random, std::span<double> y) {
      y[0] = DrawNormal(random);
      return random.Uniform() > share;
    };
  };
  const auto few = Propagate(1, failing(0.002), {});
  ASSERT_TRUE(few.ok()) << few.status();
  EXPECT_GT(few->failed, 0u);
  EXPECT_EQ(Propagate(1, failing(0.3), {}).status().code(), absl::StatusCode::kFailedPrecondition);
}

TEST(MonteCarloTest, OptionsOutOfRangeAreRefused) {
  const Trial trial = [](RandomStream&, std::span<double>) { return true; };
  EXPECT_THAT(Propagate(1, trial, {.coverage = 1}).status().message(),
              testing::HasSubstr("coverage"));
  EXPECT_THAT(Propagate(1, trial, {.digits = 0}).status().message(), testing::HasSubstr("digits"));
  EXPECT_FALSE(Propagate(0, trial, {}).ok());
}

}  // namespace
}  // namespace eyebox::fit
