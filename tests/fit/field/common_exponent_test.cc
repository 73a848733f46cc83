#include "fit/field/common_exponent.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/fit/field/simulated_field.h"

namespace eyebox::fit {
namespace {

using ::testing::HasSubstr;
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

void ExpectError(const absl::Status& status, absl::StatusCode code, const std::string& part) {
  EXPECT_EQ(status.code(), code) << status;
  EXPECT_THAT(std::string(status.message()), HasSubstr(part));
}

TEST(CommonExponentTest, TruthWithoutNoiseIsRecovered) {
  for (const double gamma : {0.4, 1.0, 1.8, 2.2, 5.0, 7.5}) {
    const SimulatedField field = SimulateField({1000, 17, gamma});
    const auto fit = FitCommonExponent(field.Stack());
    ASSERT_TRUE(fit.ok()) << fit.status();
    EXPECT_NEAR(fit->gamma, gamma, 1e-6) << fit->termination;
    EXPECT_EQ(fit->locations, 1000U);
    EXPECT_EQ(fit->degrees_of_freedom, 14999);
    EXPECT_LT(fit->rms_relative, 1e-6);
    for (size_t i = 0; i < 1000; ++i) {
      ASSERT_NEAR(fit->gain[i] / field.gains[i], 1, 1e-5) << "gamma " << gamma;
      ASSERT_NEAR(fit->offset[i], field.offsets[i], 1e-5 * field.gains[i]) << "gamma " << gamma;
    }
  }
}

// Truth lies where the sigmas say, over seeds for gamma and over locations for k and delta.
TEST(CommonExponentTest, SigmasAreThoseOfTheErrors) {
  double gamma_score = 0;
  double gain_score = 0;
  double offset_score = 0;
  constexpr int kFields = 200;
  constexpr size_t kPlaces = 130;
  for (uint64_t seed = 1; seed <= kFields; ++seed) {
    // Equal noise at all levels and weights to match, as the sigmas assume.
    SimulatedField field = SimulateField({kPlaces, 12, 2.2, 0, 1, seed});
    RandomStream random({seed, 99});
    for (float& luminance : field.luminance) {
      luminance += static_cast<float>(0.5 * std::sqrt(12.0) * (random.Uniform() - 0.5));
    }
    CommonExponentOptions options;
    options.level_weights.assign(12, 1);
    const auto fit = FitCommonExponent(field.Stack(), options);
    ASSERT_TRUE(fit.ok()) << fit.status();
    gamma_score += std::pow((fit->gamma - 2.2) / fit->gamma_sigma, 2) / kFields;
    for (size_t i = 0; i < kPlaces; ++i) {
      const double share = 1.0 / (kFields * kPlaces);
      gain_score += share * std::pow((fit->gain[i] - field.gains[i]) / fit->gain_sigma[i], 2);
      offset_score +=
          share * std::pow((fit->offset[i] - field.offsets[i]) / fit->offset_sigma[i], 2);
    }
    EXPECT_NEAR(fit->weighted_sum_of_squares / fit->degrees_of_freedom, 0.25, 0.05);
  }
  EXPECT_NEAR(std::sqrt(gamma_score), 1, 0.12);
  // Student's t of about 10 degrees of freedom: its rms is 1.12.
  EXPECT_NEAR(std::sqrt(gain_score), 1.12, 0.06);
  EXPECT_NEAR(std::sqrt(offset_score), 1.12, 0.06);
}

TEST(CommonExponentTest, MaskedLocationsChangeNothingAndHaveNoNumber) {
  const SimulatedField all = SimulateField({300, 9, 2.4, 0.01});
  SimulatedField masked = all;
  masked.luminance.clear();
  // Every valid location is followed by a spoilt one.
  for (const float luminance : all.luminance) {
    masked.luminance.push_back(luminance);
    masked.luminance.push_back(kNaN);
  }
  for (size_t i = 0; i < 600; ++i) masked.valid.push_back(i % 2 == 0 ? 1 : 0);
  const auto plain = FitCommonExponent(all.Stack());
  const auto fit = FitCommonExponent(masked.Stack());
  ASSERT_TRUE(plain.ok() && fit.ok()) << plain.status() << fit.status();
  EXPECT_NEAR(fit->gamma, plain->gamma, 1e-12);
  EXPECT_NEAR(fit->gamma_sigma, plain->gamma_sigma, 1e-9);
  EXPECT_EQ(fit->locations, 300U);
  EXPECT_EQ(fit->degrees_of_freedom, plain->degrees_of_freedom);
  ASSERT_EQ(fit->gain.size(), 600U);
  for (size_t i = 0; i < 600; ++i) {
    for (const auto* map : {&fit->gain, &fit->gain_sigma, &fit->offset, &fit->offset_sigma}) {
      ASSERT_EQ(std::isnan((*map)[i]), i % 2 == 1) << i;
    }
    if (i % 2 == 1) continue;
    ASSERT_FLOAT_EQ(fit->gain[i], plain->gain[i / 2]);
  }
}

TEST(CommonExponentTest, LuminanceOfAnyUnitIsFittedAlike) {
  const auto expected = FitCommonExponent(SimulateField({500, 17, 2.2, 0.01}).Stack());
  ASSERT_TRUE(expected.ok()) << expected.status();
  for (const double unit : {1e-35, 1e-4, 1e5, 1e35}) {
    const SimulatedField field = SimulateField({500, 17, 2.2, 0.01, unit});
    const auto fit = FitCommonExponent(field.Stack());
    ASSERT_TRUE(fit.ok()) << fit.status();
    EXPECT_NEAR(fit->gamma, expected->gamma, 1e-6) << unit;
    EXPECT_NEAR(fit->gain[7] / unit / expected->gain[7], 1, 1e-5) << unit;
  }
}

TEST(CommonExponentTest, AnyNumberOfLocationsAndLevelsIsFitted) {
  for (const size_t locations : {1, 2, 7, 127, 128, 129, 255, 1000}) {
    for (const size_t levels : {4, 5, 6, 33}) {
      const SimulatedField field = SimulateField({locations, levels, 2.2});
      const auto fit = FitCommonExponent(field.Stack());
      ASSERT_TRUE(fit.ok()) << fit.status();
      EXPECT_NEAR(fit->gamma, 2.2, 1e-5) << locations << " x " << levels;
      ASSERT_EQ(fit->gain.size(), locations);
      EXPECT_NEAR(fit->gain.back() / field.gains.back(), 1, 1e-5);
    }
  }
}

TEST(CommonExponentTest, OrderOfLevelsDoesNotMatter) {
  const SimulatedField field = SimulateField({200, 9, 2.2, 0.01});
  SimulatedField turned = field;
  std::reverse(turned.drives.begin(), turned.drives.end());
  for (size_t level = 0; level < 9; ++level) {
    std::copy_n(field.luminance.begin() + level * 200, 200,
                turned.luminance.begin() + (8 - level) * 200);
  }
  const auto fit = FitCommonExponent(field.Stack());
  const auto again = FitCommonExponent(turned.Stack());
  ASSERT_TRUE(fit.ok() && again.ok());
  EXPECT_NEAR(again->gamma, fit->gamma, 1e-12);
}

TEST(CommonExponentTest, NegativeDarkLevelsAreFitted) {
  SimulatedField field = SimulateField({200, 9, 2.2, 0.001});
  for (size_t i = 0; i < 200; ++i) field.luminance[i] = -0.01F;  // black less its dark frame
  for (size_t i = 200; i < field.luminance.size(); ++i) {
    field.luminance[i] -= static_cast<float>(field.offsets[i % 200]) + 0.01F;
  }
  const auto fit = FitCommonExponent(field.Stack());
  ASSERT_TRUE(fit.ok()) << fit.status();
  EXPECT_NEAR(fit->gamma, 2.2, 0.01);
}

TEST(CommonExponentTest, BadStacksAreNamed) {
  constexpr auto kInvalid = absl::StatusCode::kInvalidArgument;
  SimulatedField field = SimulateField({10, 5});
  field.luminance.pop_back();
  ExpectError(FitCommonExponent(field.Stack()).status(), kInvalid, "no multiple of 5 levels");
  field = SimulateField({10, 5});
  field.valid.assign(9, 1);
  ExpectError(FitCommonExponent(field.Stack()).status(), kInvalid, "mask has 9 places");
  for (const float value : {kNaN, std::numeric_limits<float>::infinity()}) {
    field = SimulateField({1000, 5});
    field.luminance[2 * 1000 + 321] = value;
    ExpectError(FitCommonExponent(field.Stack()).status(), kInvalid, "level 3, location 321");
  }
  field = SimulateField({10, 5});
  field.drives[3] = field.drives[1];
  ExpectError(FitCommonExponent(field.Stack()).status(), kInvalid, "level 4: drive value 0.25");
  field.drives[3] = 1.5;
  ExpectError(FitCommonExponent(field.Stack()).status(), kInvalid, "level 4: drive value 1.5");
}

TEST(CommonExponentTest, BadOptionsAreNamed) {
  const SimulatedField field = SimulateField({10, 5});
  for (const double weight : {0.0, -1.0, std::nan(""), HUGE_VAL}) {
    CommonExponentOptions options;
    options.level_weights = {1, 1, weight, 1, 1};
    ExpectError(FitCommonExponent(field.Stack(), options).status(),
                absl::StatusCode::kInvalidArgument, "level 3: weight");
  }
  CommonExponentOptions options;
  options.level_weights = {1, 1};
  ExpectError(FitCommonExponent(field.Stack(), options).status(),
              absl::StatusCode::kInvalidArgument, "2 for 5 levels");
  options = {};
  options.gamma_min = 9;
  ExpectError(FitCommonExponent(field.Stack(), options).status(),
              absl::StatusCode::kInvalidArgument, "9 to 8 is no interval");
}

TEST(CommonExponentTest, FieldsWithoutAnExponentAreRejected) {
  constexpr auto kRejected = absl::StatusCode::kFailedPrecondition;
  ExpectError(FitCommonExponent(SimulateField({10, 3}).Stack()).status(), kRejected, "3 levels");
  SimulatedField field = SimulateField({10, 5});
  field.valid.assign(10, 0);
  ExpectError(FitCommonExponent(field.Stack()).status(), kRejected, "no valid location");
  ExpectError(FitCommonExponent({field.drives, {}, {}}).status(), kRejected, "no valid location");
  field = SimulateField({10, 5});
  std::fill(field.luminance.begin(), field.luminance.end(), 3.0F);
  ExpectError(FitCommonExponent(field.Stack()).status(), kRejected, "does not rise");
  std::fill(field.luminance.begin(), field.luminance.end(), 0.0F);
  ExpectError(FitCommonExponent(field.Stack()).status(), kRejected, "does not rise");
  field = SimulateField({10, 5});
  std::reverse(field.drives.begin(), field.drives.end());  // a falling field
  ExpectError(FitCommonExponent(field.Stack()).status(), kRejected, "does not rise");
  const SimulatedField steep = SimulateField({10, 17, 9.5});
  ExpectError(FitCommonExponent(steep.Stack()).status(), kRejected, "between gamma 0.3 and 8");
}

}  // namespace
}  // namespace eyebox::fit
