#include "fit/field/exponent_by_region.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <boost/math/distributions/fisher_f.hpp>

#include "fit/field/f_distribution.h"
#include "tests/fit/field/gradient_field.h"

namespace eyebox::fit {
namespace {

using ::testing::HasSubstr;

TEST(FTailTest, AgreesWithBoost) {
  for (const double numerator : {1.0, 2.0, 8.0, 63.0}) {
    for (const double denominator : {1.0, 5.0, 200.0, 5e4, 1e7}) {
      const boost::math::fisher_f distribution(numerator, denominator);
      for (const double f : {1e-6, 0.1, 0.7, 1.0, 1.5, 3.0, 30.0}) {
        const double exact = boost::math::cdf(boost::math::complement(distribution, f));
        if (exact < 1e-250) continue;
        EXPECT_NEAR(FTail(f, numerator, denominator) / exact, 1, 1e-7)
            << f << " " << numerator << " " << denominator;
      }
    }
  }
  EXPECT_EQ(FTail(0, 3, 100), 1);
  EXPECT_EQ(FTail(-1, 3, 100), 1);
}

// 4000 replicates of several fields: tests/tools/field_test_size.cc. Bounds of 3.3 sigma here.
TEST(CompareRegionsTest, TheTestKeepsItsSize) {
  EXPECT_NEAR(RejectedShare({.masked_share = 0.1, .seed = 40000}, 600), 0.05, 0.03);
}

TEST(CompareRegionsTest, AGradientOfThreePercentIsFound) {
  EXPECT_GT(RejectedShare({.relative_gradient = 0.03, .seed = 50000}, 100), 0.95);
}

TEST(CompareRegionsTest, RegionsShowTheGradient) {
  const GradientField field =
      SimulateGradient({.locations = 300, .levels = 17, .relative_gradient = 0.03, .seed = 5});
  const auto weights = RelativeFieldWeights(field.Stack());
  const auto compared = CompareRegions(field.Stack(), *weights, field.regions);
  ASSERT_TRUE(compared.ok()) << compared.status();
  EXPECT_FALSE(compared->one_serves);
  EXPECT_LT(compared->delta_bic, 0);
  EXPECT_THAT(compared->reason, HasSubstr("varies over the field"));
  ASSERT_EQ(compared->regions.size(), 3U);
  for (int i = 0; i < 3; ++i) {
    const SharedExponentFit& fit = compared->regions[i].fit;
    EXPECT_NEAR(fit.gamma, 2.2 * (1 + 0.01 * (i - 1)), 4 * fit.gamma_sigma);
    EXPECT_LT(fit.gamma_sigma, 0.003);
  }
}

TEST(CompareRegionsTest, LocationsWithoutARegionAreLeftOutOfBoth) {
  GradientField field = SimulateGradient({.locations = 60, .seed = 6});
  for (int i = 0; i < 10; ++i) field.regions[i] = -1;
  for (size_t level = 0; level < 9; ++level) field.luminance[level * 60] *= 1 + level;
  const auto weights = RelativeFieldWeights(field.Stack());
  const auto compared = CompareRegions(field.Stack(), *weights, field.regions);
  ASSERT_TRUE(compared.ok()) << compared.status();
  EXPECT_EQ(compared->common.locations, 50U);
  EXPECT_EQ(compared->denominator_freedom, 50 * 7 - 3);
  EXPECT_EQ(compared->numerator_freedom, 2);
  EXPECT_TRUE(compared->one_serves);
}

TEST(CompareRegionsTest, OneRegionIsNoComparison) {
  GradientField field = SimulateGradient({});
  field.regions.assign(field.regions.size(), 0);
  const auto weights = RelativeFieldWeights(field.Stack());
  EXPECT_TRUE(
      absl::IsFailedPrecondition(CompareRegions(field.Stack(), *weights, field.regions).status()));
  field.regions.pop_back();
  EXPECT_TRUE(
      absl::IsInvalidArgument(CompareRegions(field.Stack(), *weights, field.regions).status()));
}

}  // namespace
}  // namespace eyebox::fit
