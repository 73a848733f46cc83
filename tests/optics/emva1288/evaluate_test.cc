#include "optics/sensor/emva1288/evaluate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace eyebox::optics {
namespace {

using testing::Contains;
using testing::HasSubstr;

SetStatistics Dark(double exposure_s, double mean_dn = 10, double variance_dn2 = 4) {
  SetStatistics set;
  set.condition = {.where = "dark", .dark = true, .exposure_s = exposure_s};
  set.images = 2;
  set.pixels = 1e6;
  set.mean_dn = mean_dn;
  set.temporal_variance_dn2 = variance_dn2;
  set.temporal_variance_sigma_dn2 = variance_dn2 * 1e-3;
  set.mean_sigma_dn = 1e-3;
  return set;
}

// K = 0.5 DN/e, eta = 0.5, dark of 10 DN with 4 DN^2.
SetStatistics Bright(double photons, double exposure_s = 0.01) {
  SetStatistics set = Dark(exposure_s);
  set.condition.where = "bright";
  set.condition.dark = false;
  set.condition.irradiation = photons;
  set.mean_dn += 0.25 * photons;
  set.temporal_variance_dn2 += 0.5 * 0.25 * photons;
  set.temporal_variance_sigma_dn2 = set.temporal_variance_dn2 * 1e-3;
  set.spatial_variance_dn2 = set.highpass_variance_dn2 = 1 + std::pow(0.01 * 0.25 * photons, 2);
  return set;
}

std::vector<SetStatistics> Series(int steps) {
  std::vector<SetStatistics> sets = {Dark(0.01)};
  sets[0].spatial_variance_dn2 = sets[0].highpass_variance_dn2 = 1;
  for (int k = 1; k <= steps; ++k) sets.push_back(Bright(100.0 * k));
  // The sensor clips: the signal stays, the noise is gone.
  for (int k = 1; k <= 3; ++k) {
    SetStatistics clipped = Bright(100.0 * steps);
    clipped.condition.irradiation = 100.0 * (steps + k);
    clipped.temporal_variance_dn2 = 0;
    sets.push_back(clipped);
  }
  return sets;
}

TEST(EvaluateEmva1288Test, ExactStatisticsGiveExactFigures) {
  const auto result = EvaluateEmva1288(Series(60));
  ASSERT_TRUE(result.ok()) << result.status();
  EXPECT_NEAR(result->gain_dn_per_e.value, 0.5, 1e-12);
  EXPECT_NEAR(result->quantum_efficiency->value, 0.5, 1e-12);
  EXPECT_NEAR(result->dark_noise_dn.value, 2, 1e-12);
  EXPECT_NEAR(result->dark_noise_e.value, std::sqrt(4 - 1.0 / 12) / 0.5, 1e-12);
  EXPECT_NEAR(result->saturation_irradiation.value, 6000, 1e-9);
  EXPECT_NEAR(result->saturation_e.value, 3000, 1e-9);
  EXPECT_NEAR(result->plateau_e->value, 3000, 1e-9);
  EXPECT_NEAR(result->threshold_e.value, std::sqrt(16.25) + 0.5, 1e-12);
  EXPECT_NEAR(result->dsnu_e.value, 2, 1e-12);
  EXPECT_NEAR(result->prnu.value, 0.01, 1e-12);
  EXPECT_NEAR(result->linearity->maximum, 0, 1e-12);
  EXPECT_FALSE(result->dark_current.has_value()) << "one exposure tells nothing of it";
}

TEST(EvaluateEmva1288Test, SeriesThatNeverSaturatesGivesLowerBounds) {
  auto sets = Series(60);
  sets.resize(sets.size() - 3);
  const auto result = EvaluateEmva1288(sets);
  ASSERT_TRUE(result.ok()) << result.status();
  EXPECT_FALSE(result->saturation_reached);
  EXPECT_FALSE(result->plateau_e.has_value());
  EXPECT_THAT(result->warnings, Contains(HasSubstr("lower bounds")));
}

TEST(EvaluateEmva1288Test, BrightSetWithoutItsDarkIsNamed) {
  auto sets = Series(60);
  sets.push_back(Bright(150, 0.02));
  const auto result = EvaluateEmva1288(sets);
  EXPECT_EQ(result.status().code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(result.status().message(), HasSubstr("0.02 s"));
}

TEST(EvaluateEmva1288Test, TwoStepsAreTooFew) {
  const std::vector<SetStatistics> sets = {Dark(0.01), Bright(100), Bright(200)};
  EXPECT_EQ(EvaluateEmva1288(sets).status().code(), absl::StatusCode::kFailedPrecondition);
}

TEST(EvaluateEmva1288Test, NoiseThatDoesNotGrowIsRejected) {
  auto sets = Series(60);
  for (SetStatistics& set : sets) set.temporal_variance_dn2 = 4;
  EXPECT_EQ(EvaluateEmva1288(sets).status().code(), absl::StatusCode::kFailedPrecondition);
}

TEST(EvaluateEmva1288Test, DarkNoiseBelowQuantisationIsHeldAtTheStandardsLimit) {
  auto sets = Series(60);
  for (SetStatistics& set : sets) {
    if (set.temporal_variance_dn2 > 0) set.temporal_variance_dn2 -= 3.9;
  }
  const auto result = EvaluateEmva1288(sets);
  ASSERT_TRUE(result.ok()) << result.status();
  EXPECT_TRUE(result->dark_noise_is_quantisation);
  EXPECT_NEAR(result->dark_noise_dn.value, std::sqrt(0.24), 1e-12);
}

TEST(EvaluateEmva1288Test, DarkCurrentAndItsSlopeOnTemperature) {
  auto sets = Series(60);
  sets.erase(sets.begin());
  for (const double degC : {20.0, 30.0}) {
    for (const double exposure_s : {0.01, 1.0, 2.0, 4.0}) {
      // K = 0.5: 40 e/s at 25 degC, 3 e/s more for every kelvin.
      const double rate_dn_s = 0.5 * (40 + 3 * (degC - 25));
      SetStatistics dark = Dark(exposure_s, 10 + rate_dn_s * exposure_s);
      dark.condition.temperature_degC = degC;
      dark.spatial_variance_dn2 = dark.highpass_variance_dn2 = 1;
      sets.push_back(dark);
    }
  }
  const auto result = EvaluateEmva1288(sets);
  ASSERT_TRUE(result.ok()) << result.status();
  ASSERT_TRUE(result->dark_current.has_value());
  const DarkCurrent& current = *result->dark_current;
  EXPECT_NEAR(current.from_mean_e_s.value, 40, 0.5);
  ASSERT_TRUE(current.per_kelvin_e_s_K.has_value());
  EXPECT_NEAR(current.per_kelvin_e_s_K->value, 3, 0.05);
  EXPECT_NEAR(*current.temperature_degC, 25, 1e-9);
}

TEST(EvaluateEmva1288Test, NoisyRiseBelowThePeakIsNotTakenForSaturation) {
  auto sets = Series(60);
  sets[20].temporal_variance_dn2 = 1e6;  // a lamp that flickered
  const auto result = EvaluateEmva1288(sets);
  ASSERT_TRUE(result.ok()) << result.status();
  EXPECT_NEAR(result->saturation_irradiation.value, 6000, 1e-9);
}

}  // namespace
}  // namespace eyebox::optics
