// Where w ends, found from readings that contradict the reach that is taken unless they tell.
#include "fit/scatter/find_reach.h"

#include <gtest/gtest.h>

#include <cmath>

#include "fit/scatter/glare_model.h"
#include "tests/fit/scatter/simulated_glare.h"

namespace eyebox::fit {
namespace {

// A tail so wide that a quarter of its energy would lie beyond the reach.
optics::ScatterKernel Ending(double reach_deg) {
  return {.core_radius_deg = 0.06,
          .tail_share = 0.05,
          .tail_radius_deg = 4,
          .tail_exponent = 3,
          .reach_deg = reach_deg};
}

ScatterFitOptions Finding() {
  ScatterFitOptions options;
  options.find_reach = true;
  return options;
}

GlareScene Precise() {
  GlareScene scene;
  scene.relative_sigma = 0.0005;
  return scene;
}

TEST(FindReach, ReachAndSharesHaveHonestSigmas) {
  double reach_squares = 0, share_squares = 0;
  constexpr int kSeries = 30;
  for (uint64_t seed = 1; seed <= kSeries; ++seed) {
    const auto truth = Ending(20);
    const auto fit = FitScatter(SimulateGlare(truth, Precise(), seed), Finding());
    ASSERT_TRUE(fit.ok()) << fit.status();
    ASSERT_GT(fit->reach_sigma_deg, 0) << "seed " << seed;
    EXPECT_LT(fit->reach_sigma_deg, 1);
    EXPECT_LT(fit->chi_square, fit->degrees_of_freedom + 4 * std::sqrt(2 * 27));
    reach_squares += std::pow((fit->kernel.reach_deg - 20) / fit->reach_sigma_deg, 2);
    const Parameter& share = fit->parameters[kTailShare];
    share_squares += std::pow((share.value - truth.tail_share) / share.sigma, 2);
  }
  std::printf("rms pull of the reach %.2f, of the tail's share %.2f\n",
              std::sqrt(reach_squares / kSeries), std::sqrt(share_squares / kSeries));
  EXPECT_NEAR(std::sqrt(reach_squares / kSeries), 1, 4 / std::sqrt(2.0 * kSeries));
  EXPECT_NEAR(std::sqrt(share_squares / kSeries), 1, 4 / std::sqrt(2.0 * kSeries));
}

TEST(FindReach, HeldTooWideTheReadingsContradictIt) {
  const auto series = SimulateGlare(Ending(20), Precise(), 1);
  const auto held = FitScatter(series);
  ASSERT_TRUE(held.ok()) << held.status();
  EXPECT_EQ(held->kernel.reach_deg, 60);
  EXPECT_EQ(held->reach_sigma_deg, 0);
  EXPECT_GT(held->chi_square, 10 * held->degrees_of_freedom) << "else nothing is shown here";
}

TEST(FindReach, WhatIsNotContradictedStaysHeld) {
  const auto series = SimulateGlare(Ending(60), Precise(), 2);
  const auto held = FitScatter(series);
  const auto found = FitScatter(series, Finding());
  ASSERT_TRUE(held.ok() && found.ok());
  EXPECT_EQ(found->reach_sigma_deg, 0);
  EXPECT_EQ(found->kernel.reach_deg, 60);
  EXPECT_EQ(found->covariance, held->covariance);
}

TEST(FindReach, AMisfitOfAnotherKindIsNotTakenForTheReach) {
  auto series = SimulateGlare(Ending(60), Precise(), 3);
  series.readings[4].luminance *= 1.05;  // something went wrong there
  const auto found = FitScatter(series, Finding());
  ASSERT_TRUE(found.ok()) << found.status();
  EXPECT_GT(found->chi_square, 3 * found->degrees_of_freedom);
  EXPECT_EQ(found->kernel.reach_deg, 60);
  EXPECT_NEAR(found->kernel.tail_share, 0.05, 4 * found->parameters[kTailShare].sigma);
}

TEST(FindReach, AnotherRoundStartsFromTheReachFound) {
  const auto first = FitScatter(SimulateGlare(Ending(25), Precise(), 4), Finding());
  ASSERT_TRUE(first.ok()) << first.status();
  const auto next = FitScatterFrom(*first, SimulateGlare(Ending(24), Precise(), 5), Finding());
  ASSERT_TRUE(next.ok()) << next.status();
  EXPECT_NEAR(first->kernel.reach_deg, 25, 4 * first->reach_sigma_deg);
  EXPECT_NEAR(next->kernel.reach_deg, 24, 4 * next->reach_sigma_deg);
}

}  // namespace
}  // namespace eyebox::fit
