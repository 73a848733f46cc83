#include "optics/sensor/emva1288/set_statistics.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace eyebox::optics {
namespace {

using testing::HasSubstr;

constexpr ImageSize kSize{200, 150};

SetCondition Condition() { return {.where = "here", .dark = true, .exposure_s = 0.1}; }

// `pattern` is the mean of each pixel, `drift` what each image is brighter than the last.
SetStatistics Measure(const Image<float>& pattern, double noise_dn, double drift, int images,
                      int colour_period_px = 1) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal(0, noise_dn);
  SetAccumulator set(Condition(), {12}, colour_period_px);
  for (int k = 0; k < images; ++k) {
    Image<uint16_t> image(pattern.size());
    for (size_t i = 0; i < image.pixels().size(); ++i) {
      const double dn = pattern.pixels()[i] + k * drift + normal(random);
      image.pixels()[i] = static_cast<uint16_t>(std::lround(dn));
    }
    EXPECT_TRUE(set.Add({image.pixels(), image.size()}).ok());
  }
  return set.Finish()->statistics;
}

Image<float> Pattern(double sigma_dn) {
  std::mt19937_64 random(8);
  std::normal_distribution<double> normal(1000, sigma_dn);
  Image<float> pattern(kSize);
  for (float& dn : pattern.pixels()) dn = static_cast<float>(normal(random));
  return pattern;
}

TEST(SetStatisticsTest, TemporalAndSpatialVarianceAreToldApart) {
  for (const int images : {2, 16}) {
    const SetStatistics set = Measure(Pattern(5), 4, 0, images);
    const double temporal = 16 + 1.0 / 12;
    EXPECT_NEAR(set.temporal_variance_dn2, temporal, 4 * set.temporal_variance_sigma_dn2);
    EXPECT_NEAR(set.spatial_variance_dn2, 25, 4 * set.spatial_variance_sigma_dn2);
    EXPECT_NEAR(set.highpass_variance_dn2, 25, 5 * set.highpass_variance_sigma_dn2);
    EXPECT_LT(set.spatial_variance_sigma_dn2, 0.5);
  }
}

TEST(SetStatisticsTest, DriftBetweenImagesIsNotNoise) {
  const SetStatistics set = Measure(Pattern(0), 4, 30, 2);
  EXPECT_NEAR(set.temporal_variance_dn2, 16 + 1.0 / 12, 4 * set.temporal_variance_sigma_dn2);
}

TEST(SetStatisticsTest, ColoursOfAMosaicCountAsSeparateSensors) {
  Image<float> pattern = Pattern(5);
  for (int y = 0; y < kSize.height_px; ++y) {
    for (int x = 0; x < kSize.width_px; ++x) {
      pattern.at(x, y) += x % 2 == 0 ? 0.0F : 500.0F;
    }
  }
  const SetStatistics set = Measure(pattern, 2, 0, 8, 2);
  EXPECT_NEAR(set.spatial_variance_dn2, 25, 4 * set.spatial_variance_sigma_dn2);
  EXPECT_NEAR(set.highpass_variance_dn2, 25, 5 * set.highpass_variance_sigma_dn2);
}

TEST(SetStatisticsTest, OneImageOrTinyImagesAreRejected) {
  SetAccumulator one(Condition(), {12}, 1);
  const Image<uint16_t> image({8, 8}, 5);
  ASSERT_TRUE(one.Add({image.pixels(), image.size()}).ok());
  EXPECT_THAT(one.Finish().status().message(), HasSubstr("here: it has 1 image"));

  SetAccumulator tiny(Condition(), {12}, 1);
  const Image<uint16_t> small({5, 8}, 5);
  for (int k = 0; k < 2; ++k) ASSERT_TRUE(tiny.Add({small.pixels(), small.size()}).ok());
  EXPECT_THAT(tiny.Finish().status().message(), HasSubstr("too small"));
}

TEST(SetStatisticsTest, ImagesWithoutAnyNoiseGiveZeroNotLess) {
  const SetStatistics set = Measure(Image<float>(kSize, 77), 0, 0, 2);
  EXPECT_EQ(set.temporal_variance_dn2, 0);
  EXPECT_EQ(set.spatial_variance_dn2, 0);
  EXPECT_EQ(set.mean_dn, 77);
}

}  // namespace
}  // namespace eyebox::optics
