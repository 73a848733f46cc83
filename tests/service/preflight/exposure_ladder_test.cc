#include "service/preflight/exposure_ladder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "tests/service/preflight/preflight_bench.h"

namespace eyebox::service {
namespace {

using testing::HasSubstr;

// signal = 1000 (t / 10 ms)^exponent at 0.4, 0.8, ... 12.8 ms.
std::vector<LadderRung> Ladder(double exponent, double relative_sigma = 1e-3) {
  std::vector<LadderRung> rungs;
  for (double exposure_s = 4e-4; exposure_s < 0.02; exposure_s *= 2) {
    const double signal_dn = 1000 * std::pow(exposure_s / 0.01, exponent);
    rungs.push_back({exposure_s, signal_dn, relative_sigma * signal_dn, false});
  }
  return rungs;
}

TEST(ExposureLadder, OfALinearCameraHasSlopeOne) {
  const Check check = CheckExposureLadder(Ladder(1));
  EXPECT_EQ(check.verdict, Verdict::kPassed) << check.cause;
  EXPECT_NEAR(check.measured->value, 1, 1e-12);
  EXPECT_NEAR(FigureOf(check, "decades"), std::log10(32), 1e-12);
}

// sigma_slope = sigma_y / sqrt(sum (x - mean)^2), with the floor of a rung in sigma_y.
TEST(ExposureLadder, GivesTheSigmaOfItsSlope) {
  const double spread = std::log(2) * std::sqrt(17.5);
  EXPECT_NEAR(CheckExposureLadder(Ladder(1)).measured->sigma, std::hypot(1e-3, 5e-4) / spread,
              1e-9);
}

TEST(ExposureLadder, NamesGammaAndItsExponent) {
  const Check check = CheckExposureLadder(Ladder(0.45));
  EXPECT_EQ(check.verdict, Verdict::kFailed);
  EXPECT_THAT(check.cause, HasSubstr("to the power 0.45"));
}

TEST(ExposureLadder, FailsJustBeyondItsThreshold) {
  EXPECT_EQ(CheckExposureLadder(Ladder(1.003)).verdict, Verdict::kPassed);
  EXPECT_EQ(CheckExposureLadder(Ladder(1.006)).verdict, Verdict::kFailed);
}

TEST(ExposureLadder, NamesAutomaticExposureWhereTheSignalStays) {
  EXPECT_THAT(CheckExposureLadder(Ladder(0)).cause, HasSubstr("automatic exposure"));
  EXPECT_THAT(CheckExposureLadder(Ladder(-0.1)).cause, HasSubstr("automatic exposure"));
}

TEST(ExposureLadder, NamesUnsteadyLightEvenWhereItLeavesNothingToFit) {
  std::vector<LadderRung> flashing = Ladder(1, 0.5);
  for (LadderRung& rung : flashing) rung.pixel_sigma_dn = 1e-3 * rung.signal_dn;
  EXPECT_THAT(CheckExposureLadder(flashing).cause, HasSubstr("not steady"));
  EXPECT_THAT(CheckExposureLadder(Ladder(1, 0.1)).cause, HasSubstr("not steady"));
}

TEST(ExposureLadder, NamesABentResponse) {
  std::vector<LadderRung> rungs = Ladder(1);
  rungs.back().signal_dn *= 0.9;
  const Check check = CheckExposureLadder(rungs);
  EXPECT_EQ(check.verdict, Verdict::kFailed);
  EXPECT_THAT(check.cause, HasSubstr("bent"));
}

TEST(ExposureLadder, WithoutEnoughRungsFailsAndSaysWhy) {
  std::vector<LadderRung> rungs = Ladder(1);
  for (LadderRung& rung : rungs) rung.saturated = true;
  EXPECT_THAT(CheckExposureLadder(rungs).cause, HasSubstr("every exposure is saturated"));
  rungs = Ladder(1);
  for (LadderRung& rung : rungs) {
    rung.signal_dn = -rung.sigma_dn;
    rung.pixel_sigma_dn = rung.sigma_dn;
  }
  EXPECT_THAT(CheckExposureLadder(rungs).cause, HasSubstr("no exposure is brighter"));
  rungs = Ladder(1);
  rungs.resize(1);
  EXPECT_THAT(CheckExposureLadder(rungs).cause, HasSubstr("only 1 of 1"));
  EXPECT_EQ(CheckExposureLadder({}).verdict, Verdict::kFailed);
  rungs = Ladder(1);
  for (LadderRung& rung : rungs) rung.signal_dn = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(CheckExposureLadder(rungs).verdict, Verdict::kFailed);
  rungs.assign(6, {.exposure_s = 0.01, .signal_dn = 100, .sigma_dn = 1, .saturated = false});
  EXPECT_THAT(CheckExposureLadder(rungs).cause, HasSubstr("0.00 decades"));
}

}  // namespace
}  // namespace eyebox::service
