#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "optics/uniformity/uniformity_map.h"
#include "tests/optics/forward_model.h"

namespace eyebox::optics {
namespace {

constexpr ImageSize kSize{161, 121};

double TrueG(int x, int y) {
  const double u = (x - 80) / 80.0;
  const double v = (y - 60) / 60.0;
  return 1 - 0.2 * u * u - 0.1 * v * v + 0.05 * u + 0.03 * u * u * v * v;
}

LuminanceImage FullField(double peak_cd_m2, double relative_sigma, uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  LuminanceImage field;
  field.absolute = true;
  field.image = MakeMeasuredImage(kSize, "cd/m2");
  for (int y = 0; y < kSize.height_px; ++y) {
    for (int x = 0; x < kSize.width_px; ++x) {
      const double truth = peak_cd_m2 * TrueG(x, y);
      const double sigma = relative_sigma * peak_cd_m2 * std::sqrt(TrueG(x, y));
      field.image.value.at(x, y) = static_cast<float>(truth + sigma * normal(random));
      field.image.variance.at(x, y) = static_cast<float>(sigma * sigma);
    }
  }
  return field;
}

TEST(UniformityTest, SmoothMapFindsTheTruthWithHonestSigmas) {
  const auto map = *MeasureUniformity(FullField(100, 0.02, 1));
  EXPECT_NEAR(map.smooth.At(80, 60), 1, 1e-12);
  EXPECT_NEAR(map.smooth.SigmaAt(80, 60), 0, 1e-9);
  const Image<float> values = map.smooth.Values();
  const Image<float> sigmas = map.smooth.Sigmas();
  double worst = 0;
  for (int y = 0; y < kSize.height_px; ++y) {
    for (int x = 0; x < kSize.width_px; ++x) {
      EXPECT_NEAR(values.at(x, y), TrueG(x, y), 5 * sigmas.at(x, y) + 1e-6);
      worst = std::max(worst, std::abs(values.at(x, y) - TrueG(x, y)));
    }
  }
  EXPECT_LT(worst, 0.01);
  EXPECT_NEAR(map.smooth.reduced_chi2, 1, 0.05);
}

TEST(UniformityTest, PullsOfTheSmoothMapHaveUnitVariance) {
  double squares = 0;
  int count = 0;
  for (uint64_t seed = 1; seed <= 60; ++seed) {
    const auto map = *MeasureUniformity(FullField(100, 0.02, seed));
    for (const auto& [x, y] : {std::pair{10, 10}, {150, 60}, {80, 110}}) {
      squares += std::pow((map.smooth.At(x, y) - TrueG(x, y)) / map.smooth.SigmaAt(x, y), 2);
      ++count;
    }
  }
  EXPECT_NEAR(std::sqrt(squares / count), 1, 4 / std::sqrt(2.0 * count));
}

TEST(UniformityTest, RawMapHasHonestSigmasAndIncludesTheReference) {
  const auto map = *MeasureUniformity(FullField(100, 0.02, 2));
  // The true mean over the reference disk is not quite g = 1 at its centre, since g curves.
  double disk = 0;
  double pixels = 0;
  for (int y = 57; y <= 63; ++y) {
    for (int x = 77; x <= 83; ++x) {
      if (std::hypot(x - 80, y - 60) > 0.02 * 121) continue;
      disk += TrueG(x, y);
      ++pixels;
    }
  }
  const auto pulls = Pulls(map.raw, [&](size_t i) {
    return TrueG(static_cast<int>(i % kSize.width_px), static_cast<int>(i / kSize.width_px)) *
           pixels / disk;
  });
  EXPECT_NEAR(pulls.rms, 1, 0.05);
  EXPECT_NEAR(map.reference_luminance_sigma, 100 * 0.02 / std::sqrt(pixels), 0.02);
  EXPECT_NEAR(map.residual_rms / map.residual_rms_expected, 1, 0.05);
}

TEST(UniformityTest, PixelsOfTheReferenceDiskVaryLess) {
  const auto map = *MeasureUniformity(FullField(100, 0.02, 3));
  EXPECT_LT(map.raw.variance.at(80, 60), map.raw.variance.at(84, 60));
}

TEST(UniformityTest, NineAndThirteenPointsByHand) {
  LuminanceImage field = FullField(100, 1e-6, 4);
  const auto map = *MeasureUniformity(field);
  ASSERT_EQ(map.nine_points.patches.size(), 9U);
  ASSERT_EQ(map.thirteen_points.patches.size(), 13U);
  EXPECT_NEAR(map.nine_points.patches[0].x_px, 16, 1e-9);
  EXPECT_NEAR(map.nine_points.patches[0].y_px, 12, 1e-9);
  EXPECT_NEAR(map.thirteen_points.patches[12].x_px, 112, 1e-9);
  // Largest where 0.05 u - 0.2 u^2 peaks among the points: the centre. Smallest: a left corner.
  const double expected = TrueG(16, 12) / TrueG(80, 60);
  EXPECT_NEAR(map.nine_points.uniformity, expected, 0.002);
  EXPECT_NEAR(map.nine_points.nonuniformity, 1 - expected, 0.002);
}

TEST(UniformityTest, PointsTellGWithWhatTheyShareWithTheReference) {
  double squares = 0, near_squares = 0;
  constexpr int kTrials = 150;
  for (int seed = 1; seed <= kTrials; ++seed) {
    const auto map = *MeasureUniformity(FullField(100, 0.01, seed));
    ASSERT_EQ(map.g_of_nine_points.size(), 9U);
    ASSERT_EQ(map.g_of_thirteen_points.size(), 13U);
    const PatchRatio& centre = map.g_of_nine_points[4];
    EXPECT_EQ(centre.value, 1) << "it is the reference itself";
    EXPECT_NEAR(centre.sigma, 0, 1e-9);
    const PatchRatio& corner = map.g_of_nine_points[0];
    EXPECT_EQ(corner.x_px, 16);
    squares += std::pow((corner.value - TrueG(16, 12)) / corner.sigma, 2);
    // Half of this patch's pixels are the reference's.
    const MeasuredImage& image = FullField(100, 0.01, seed).image;
    const PatchMean reference = *MeanOverDisk(image, 80, 60, 2.42);
    const PatchRatio near = RatioOf(image, *MeanOverDisk(image, 82, 60, 2.42), reference);
    near_squares += std::pow((near.value - TrueG(82, 60)) / near.sigma, 2);
  }
  EXPECT_NEAR(std::sqrt(squares / kTrials), 1, 4 / std::sqrt(2.0 * kTrials));
  EXPECT_NEAR(std::sqrt(near_squares / kTrials), 1, 4 / std::sqrt(2.0 * kTrials));
}

TEST(UniformityTest, SigmaOfPointUniformityMatchesItsScatter) {
  double sum = 0;
  double squares = 0;
  double stated = 0;
  constexpr int kTrials = 200;
  for (int seed = 1; seed <= kTrials; ++seed) {
    // Two patches only can be the extremes here: corners against centre.
    LuminanceImage field = FullField(100, 0.01, seed);
    const auto points = *MeasurePointUniformity(field, PointPattern::kNine, 2.5);
    sum += points.uniformity;
    squares += points.uniformity * points.uniformity;
    stated += points.sigma;
  }
  const double scatter = std::sqrt(squares / kTrials - std::pow(sum / kTrials, 2));
  EXPECT_NEAR(scatter / (stated / kTrials), 1, 0.25);
}

// Error of the scattered light that was taken out, the same number times this everywhere: 1 % of
// the peak at the centre, 4 % in the corners. The noise of a mean or a smooth model is far less.
LuminanceImage FieldWithoutGlare(uint64_t seed) {
  LuminanceImage field = FullField(100, 0.02, seed);
  field.scatter_sigma = Image<float>(kSize);
  std::mt19937_64 random(seed + 1000);
  const double error = std::normal_distribution<double>()(random);
  for (int y = 0; y < kSize.height_px; ++y) {
    for (int x = 0; x < kSize.width_px; ++x) {
      const double u = (x - 80) / 80.0;
      const double v = (y - 60) / 60.0;
      const double sigma = 1 + 1.5 * (u * u + v * v);
      field.scatter_sigma.at(x, y) = static_cast<float>(sigma);
      field.image.value.at(x, y) += static_cast<float>(error * sigma);
    }
  }
  return field;
}

TEST(UniformityTest, WhatPixelsShareOfScatteredLightIsNotAveragedAway) {
  LuminanceImage noise_alone = FieldWithoutGlare(1);
  noise_alone.scatter_sigma = {};
  const double sigma_if_independent = MeasureUniformity(noise_alone)->smooth.SigmaAt(10, 110);
  double raw = 0, smooth = 0, points = 0, if_independent = 0;
  constexpr int kTrials = 80;
  const double expected_points = TrueG(16, 12) / TrueG(80, 60);
  const double g = TrueG(10, 110);
  for (uint64_t seed = 1; seed <= kTrials; ++seed) {
    const auto map = *MeasureUniformity(FieldWithoutGlare(seed));
    raw += std::pow(map.raw.value.at(10, 110) - g, 2) / map.raw.variance.at(10, 110);
    const double error = map.smooth.At(10, 110) - g;
    smooth += std::pow(error / map.smooth.SigmaAt(10, 110), 2);
    if_independent += std::pow(error / sigma_if_independent, 2);
    points += std::pow((map.nine_points.uniformity - expected_points) / map.nine_points.sigma, 2);
  }
  const double scatter = 4 / std::sqrt(2.0 * kTrials);
  EXPECT_NEAR(std::sqrt(raw / kTrials), 1, scatter);
  EXPECT_NEAR(std::sqrt(smooth / kTrials), 1, scatter);
  EXPECT_NEAR(std::sqrt(points / kTrials), 1, scatter);
  EXPECT_GT(std::sqrt(if_independent / kTrials), 3);
}

TEST(UniformityTest, ScatteredLightThatIsProportionalCancelsInG) {
  LuminanceImage field = FullField(100, 0.02, 9);
  const auto without = *MeasureUniformity(field);
  field.scatter_sigma = field.image.value;
  for (float& sigma : field.scatter_sigma.pixels()) sigma *= 0.05F;
  const auto with = *MeasureUniformity(field);
  EXPECT_NEAR(with.smooth.SigmaAt(10, 10), without.smooth.SigmaAt(10, 10), 1e-6);
  EXPECT_NEAR(with.nine_points.sigma, without.nine_points.sigma, 1e-6);
  EXPECT_GT(with.reference_luminance_sigma, 4.9) << "but not in the luminance";
}

TEST(UniformityTest, MaskedPixelsAreIgnored) {
  LuminanceImage field = FullField(100, 0.01, 5);
  for (int y = 20; y < 50; ++y) {
    for (int x = 20; x < 50; ++x) field.image.mask.at(x, y) = kSaturated;
  }
  BlankMaskedPixels(field.image);
  const auto map = *MeasureUniformity(field);
  EXPECT_TRUE(KeepsMaskInvariant(map.raw));
  EXPECT_NEAR(map.smooth.At(35, 35), TrueG(35, 35), 5 * map.smooth.SigmaAt(35, 35));
}

TEST(UniformityTest, DarkReferenceIsRejected) {
  EXPECT_EQ(MeasureUniformity(FullField(1e-9, 10, 6)).status().code(),
            absl::StatusCode::kFailedPrecondition);
}

TEST(UniformityTest, ReferenceOutsideTheImageIsRejected) {
  UniformityOptions options;
  options.reference = PixelPoint{200, 60};
  EXPECT_EQ(MeasureUniformity(FullField(100, 0.01, 7), options).status().code(),
            absl::StatusCode::kInvalidArgument);
}

TEST(UniformityTest, OrderThatTheValidPixelsCannotDetermineIsRejected) {
  LuminanceImage field = FullField(100, 0.01, 8);
  for (int y = 0; y < kSize.height_px; ++y) {
    for (int x = 0; x < kSize.width_px; ++x) {
      if (y != 60) field.image.mask.at(x, y) = kSaturated;
    }
  }
  BlankMaskedPixels(field.image);
  EXPECT_EQ(FitSmoothField(field.image, FieldModel::kPolynomial, 4).status().code(),
            absl::StatusCode::kFailedPrecondition);
  EXPECT_EQ(FitSmoothField(field.image, FieldModel::kPolynomial, kLargestOrder + 1).status().code(),
            absl::StatusCode::kInvalidArgument);
}

}  // namespace
}  // namespace eyebox::optics
