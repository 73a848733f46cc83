#include "fit/base/conditioning.h"

#include <gtest/gtest.h>

#include <cmath>

namespace eyebox::fit {
namespace {

TEST(ConditionNumberTest, IndependentParametersHaveOneWhateverTheirUnits) {
  const double covariance[] = {1e-8, 0, 0, 0, 4, 0, 0, 0, 1e6};
  EXPECT_NEAR(ConditionNumber(covariance), 1, 1e-12);
}

TEST(ConditionNumberTest, TwoParametersOfCorrelationR) {
  for (const double r : {0.5, -0.9, 0.9999}) {
    // The product of these variances would leave the range of doubles.
    const double covariance[] = {1e-250, 3e-250 * r, 3e-250 * r, 9e-250};
    EXPECT_NEAR(ConditionNumber(covariance) * (1 - std::abs(r)) / (1 + std::abs(r)), 1, 1e-9);
  }
}

TEST(ConditionNumberTest, HeldParametersAreLeftOut) {
  const double covariance[] = {1, 0, 0.5, 0, 0, 0, 0.5, 0, 1};
  EXPECT_NEAR(ConditionNumber(covariance), 3, 1e-12);
  const double one[] = {1, 0, 0, 0};
  EXPECT_EQ(ConditionNumber(one), 1);
}

TEST(ConditionNumberTest, DependentParametersAreInfinite) {
  const double covariance[] = {1, 1, 1, 1};
  EXPECT_TRUE(std::isinf(ConditionNumber(covariance)));
}

}  // namespace
}  // namespace eyebox::fit
