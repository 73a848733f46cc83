#include "optics/reduce/linearise.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "optics/reduce/measure_exposure_pairs.h"
#include "optics/reduce/reduce_level.h"
#include "tests/optics/forward_model.h"

namespace eyebox::optics {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

// Counts of a sensor that loses `loss` of its signal at 1000 DN, quadratically.
double Answer(double light, double loss) { return light * (1 - loss * light / 1000); }

std::vector<LinearityPair> Pairs(double loss, double sigma_dn = 0.01) {
  std::vector<LinearityPair> pairs;
  for (double light = 4; light < 480; light *= 1.1) {
    pairs.push_back({Answer(light, loss), Answer(2 * light, loss), 2, sigma_dn * sigma_dn,
                     sigma_dn * sigma_dn});
  }
  return pairs;
}

TEST(LineariseTest, LinearSensorIsLeftAlone) {
  const auto curve = EstimateLinearity(Pairs(0));
  ASSERT_TRUE(curve.ok()) << curve.status();
  EXPECT_LT(curve->LargestRelativeCorrection(), 1e-9);
  EXPECT_NEAR(curve->At(321).value_dn, 321, 1e-6);
  EXPECT_NEAR(curve->At(321).slope, 1, 1e-8);
}

TEST(LineariseTest, CompressionIsUndoneUpToTheScaleAtTheReference) {
  const auto curve = EstimateLinearity(Pairs(0.05));
  ASSERT_TRUE(curve.ok()) << curve.status();
  const double reference = curve->reference_dn;
  EXPECT_NEAR(curve->At(reference).value_dn, reference, 1e-6 * reference);
  const auto ratio = [&](double light) { return curve->At(Answer(light, 0.05)).value_dn / light; };
  for (const double light : {5.0, 20.0, 100.0, 400.0, 900.0}) {
    EXPECT_NEAR(ratio(light) / ratio(500), 1, 0.001) << light;
  }
}

TEST(LineariseTest, StatedVarianceCoversTheErrorOfTheCurve) {
  double squared_pulls = 0;
  constexpr int kTrials = 60;
  for (int seed = 1; seed <= kTrials; ++seed) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> noise(0, 0.5);
    std::vector<LinearityPair> pairs = Pairs(0.03, 0.5);
    for (LinearityPair& pair : pairs) {
      pair.shorter_dn += noise(random);
      pair.longer_dn += noise(random);
    }
    const auto curve = EstimateLinearity(pairs, {.reference_dn = 500});
    ASSERT_TRUE(curve.ok()) << curve.status();
    // The light that reads 500 DN fixes the scale.
    const double scale = 500 / 507.74;
    const double light = 120;
    const LinearityCurve::Corrected corrected = curve->At(Answer(light, 0.03));
    squared_pulls += std::pow(corrected.value_dn - scale * light, 2) / corrected.variance_dn2;
  }
  // chi2 of 60 degrees of freedom: 99.9 % interval.
  EXPECT_GT(squared_pulls, 30.3);
  EXPECT_LT(squared_pulls, 99.6);
}

TEST(LineariseTest, StaysMonotoneAndFiniteOutsideItsData) {
  const auto curve = EstimateLinearity(Pairs(0.05));
  ASSERT_TRUE(curve.ok()) << curve.status();
  double previous = -INFINITY;
  for (double dn = -50; dn < 4000; dn += 0.5) {
    const LinearityCurve::Corrected corrected = curve->At(dn);
    ASSERT_GT(corrected.value_dn, previous) << dn;
    ASSERT_GT(corrected.slope, 0) << dn;
    ASSERT_GE(corrected.variance_dn2, 0) << dn;
    previous = corrected.value_dn;
  }
  EXPECT_EQ(curve->At(0).value_dn, 0);
}

TEST(LineariseTest, LightThatWasNotConstantIsRejected) {
  std::vector<LinearityPair> pairs = Pairs(0);
  for (LinearityPair& pair : pairs) pair.ratio = 0.5;
  EXPECT_THAT(EstimateLinearity(pairs).status().message(), HasSubstr("0 pairs"));
  pairs = Pairs(0);
  for (LinearityPair& pair : pairs) pair.ratio = pair.shorter_dn > 100 ? 40 : 2;
  const auto curve = EstimateLinearity(pairs);
  EXPECT_EQ(curve.status().code(), absl::StatusCode::kFailedPrecondition);
  EXPECT_THAT(curve.status().message(), HasSubstr("does not rise"));
}

TEST(LineariseTest, ImageKeepsItsMaskAndGainsTheVarianceOfTheCurve) {
  const auto curve = EstimateLinearity(Pairs(0.05));
  ASSERT_TRUE(curve.ok()) << curve.status();
  MeasuredImage image = MakeMeasuredImage({2, 1}, "DN");
  image.value.pixels()[0] = 900;
  image.variance.pixels()[0] = 4;
  image.mask.pixels()[1] = kSaturated;
  BlankMaskedPixels(image);
  const auto linear = Linearise(image, *curve);
  ASSERT_TRUE(linear.ok()) << linear.status();
  const LinearityCurve::Corrected corrected = curve->At(900);
  EXPECT_FLOAT_EQ(linear->value.pixels()[0], static_cast<float>(corrected.value_dn));
  EXPECT_NEAR(linear->variance.pixels()[0],
              4 * corrected.slope * corrected.slope + corrected.variance_dn2, 1e-4);
  EXPECT_TRUE(KeepsMaskInvariant(*linear));
  EXPECT_THAT(linear->history, Contains(HasSubstr("Linearise(")));
  image.unit = "DN/s";
  EXPECT_EQ(Linearise(image, *curve).status().code(), absl::StatusCode::kInvalidArgument);
}

TEST(LineariseTest, BracketOfABentCameraBecomesConsistent) {
  constexpr ImageSize kSize{160, 120};
  ForwardCamera camera(kSize, 5);
  camera.exponent = 0.97;
  Image<float> rate(kSize);
  for (int y = 0; y < kSize.height_px; ++y) {
    for (int x = 0; x < kSize.width_px; ++x) {
      rate.at(x, y) = 300.0F * std::exp2(4.0F * static_cast<float>(x) / kSize.width_px);
    }
  }
  const std::vector<double> exposures_s = {0.5, 1, 2, 4};
  Calibration calibration = camera.Calibrate(exposures_s, 16);
  std::vector<Stack> stacks;
  for (const double t : exposures_s) stacks.push_back(camera.Record(rate, t, 16));

  const auto pairs = MeasureExposurePairs(stacks, calibration);
  ASSERT_TRUE(pairs.ok()) << pairs.status();
  const auto curve = EstimateLinearity(*pairs);
  ASSERT_TRUE(curve.ok()) << curve.status();
  const auto before = ReduceRate(stacks, calibration);
  calibration.linearity = *curve;
  const auto after = ReduceRate(stacks, calibration);
  ASSERT_TRUE(after.ok()) << after.status();
  for (size_t k = 0; k < 3; ++k) {
    // 2^(0.97 - 1) = 0.979.
    EXPECT_NEAR(before->report.pairs[k].ratio, 0.979, 0.003);
    EXPECT_NEAR(after->report.pairs[k].ratio, 1, 0.002);
  }
  // Proportional to the light from end to end: a factor of 8.
  const auto column = [&](const ReducedRate& reduced, int x) {
    double sum = 0;
    for (int y = 0; y < kSize.height_px; ++y) sum += reduced.rate.value.at(x, y) / rate.at(x, y);
    return sum / kSize.height_px;
  };
  EXPECT_LT(column(*before, 140) / column(*before, 20), 0.96);
  EXPECT_NEAR(column(*after, 140) / column(*after, 20), 1, 0.005);
  EXPECT_TRUE(KeepsMaskInvariant(after->rate));
  const VarianceBudget& budget = after->report.budget;
  EXPECT_GT(budget.linearity, 0);
  EXPECT_NEAR(budget.photon + budget.read + budget.quantisation + budget.dark + budget.linearity, 1,
              0.03);
}

}  // namespace
}  // namespace eyebox::optics
