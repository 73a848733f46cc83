#include "capture/photodiode/exposure_check.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "capture/photodiode/sim/strobe_light.h"

namespace eyebox::capture {
namespace {

StrobeMeasurement Strobe(double period_s, double duty, double period_sigma_s = 0) {
  return {.strobed = true, .period_s = period_s, .period_sigma_s = period_sigma_s, .duty = duty};
}

// The light of exposures that begin at 2000 phases, against that of the mean.
double WorstByTrial(double exposure_s, const StrobeLight& light) {
  const double mean = exposure_s * light.duty;
  double worst = 0;
  for (int i = 0; i < 2000; ++i) {
    const double begin_s = light.period_s * i / 2000;
    worst = std::max(worst, std::abs(light.IntegralS(begin_s, begin_s + exposure_s) / mean - 1));
  }
  return worst;
}

TEST(ExposureCheck, WorstErrorIsThatOfTheLightItself) {
  for (const double duty : {0.05, 0.2, 0.5, 0.9}) {
    for (const double periods : {0.04, 0.3, 1.0, 1.15, 2.5, 7.95, 20.3}) {
      const StrobeLight light = {.period_s = 0.0125, .duty = duty};
      const auto check = CheckExposure(periods * 0.0125, Strobe(0.0125, duty));
      ASSERT_TRUE(check.ok()) << check.status();
      EXPECT_NEAR(check->worst_relative, WorstByTrial(periods * 0.0125, light),
                  2e-3 * (1 + check->worst_relative))
          << duty << " " << periods;
      EXPECT_LE(check->worst_relative, 1 / periods);
    }
  }
}

TEST(ExposureCheck, AWholeNumberOfPeriodsPasses) {
  const auto check = CheckExposure(9.0 / 90, Strobe(1.0 / 90, 0.2));
  ASSERT_TRUE(check.ok());
  EXPECT_TRUE(check->whole);
  EXPECT_NEAR(check->periods, 9, 1e-9);
  EXPECT_EQ(check->bound_relative, 0);
}

TEST(ExposureCheck, AnythingElseIsBoundedByOneOverThePeriods) {
  const auto check = CheckExposure(0.02, Strobe(1.0 / 90, 0.2));  // 1.8 periods
  ASSERT_TRUE(check.ok());
  EXPECT_FALSE(check->whole);
  EXPECT_NEAR(check->bound_relative, 1 / 1.8, 1e-12);
  EXPECT_NEAR(check->nearest_whole_s, 2.0 / 90, 1e-12);
}

TEST(ExposureCheck, APeriodThatIsNotWellKnownDoesNotPass) {
  const double period_s = 1.0 / 90;
  EXPECT_TRUE(CheckExposure(9 * period_s, Strobe(period_s, 0.2, 1e-7))->whole);
  EXPECT_FALSE(CheckExposure(9 * period_s, Strobe(period_s, 0.2, 1e-4))->whole);
}

TEST(ExposureCheck, ShorterThanAPeriodAdvisesOne) {
  const auto check = CheckExposure(0.001, Strobe(0.0125, 0.1));
  ASSERT_TRUE(check.ok());
  EXPECT_FALSE(check->whole);
  EXPECT_DOUBLE_EQ(check->nearest_whole_s, 0.0125);
}

TEST(ExposureCheck, OfASteadyDisplayEveryExposureIsWhole) {
  const auto check = CheckExposure(0.0123, StrobeMeasurement());
  ASSERT_TRUE(check.ok());
  EXPECT_TRUE(check->whole);
  EXPECT_EQ(check->nearest_whole_s, 0.0123);
}

TEST(ExposureCheck, NonsenseIsRefused) {
  const StrobeMeasurement strobe = Strobe(0.01, 0.2);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(absl::IsInvalidArgument(CheckExposure(0, strobe).status()));
  EXPECT_TRUE(absl::IsInvalidArgument(CheckExposure(nan, strobe).status()));
  EXPECT_TRUE(absl::IsInvalidArgument(CheckExposure(0.1, strobe, nan).status()));
}

}  // namespace
}  // namespace eyebox::capture
