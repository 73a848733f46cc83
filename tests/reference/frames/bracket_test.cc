// Seven real exposures of one scene, 8-bit Bayer, with darks of the same exposures.
#include <gtest/gtest.h>

#include <cmath>

#include "optics/reduce/reduce_level.h"
#include "tests/reference/frames/real_frames.h"

namespace eyebox::optics {
namespace {

void Print(const BracketReport& report) {
  for (const ExposureShare& share : report.exposures) {
    std::printf("%6.3f s: saturated %.4f, at the lower rail %.4f, valid %.4f\n", share.exposure_s,
                share.saturated, share.underexposed, share.valid);
  }
  for (const ExposurePairCheck& pair : report.pairs) {
    std::printf("%6.3f to %6.3f s: ratio %.5f +- %.5f over %zu pixels\n", pair.shorter_s,
                pair.longer_s, pair.ratio, pair.sigma, pair.pixels);
  }
  std::printf("hot %.6f, invalid %.6f (all saturated %.6f, all dark %.6f)\n", report.hot_share,
              report.invalid_share, report.all_saturated_share, report.all_dark_share);
  const VarianceBudget& budget = report.budget;
  std::printf("variance: photon %.3f, read %.3f, quantisation %.3f, dark %.3f\n", budget.photon,
              budget.read, budget.quantisation, budget.dark);
}

TEST_F(RealBracketTest, NoiseIsMeasuredFromTheFramesThemselves) {
  const NoiseModel& noise = calibration_.noise;
  std::printf("K = %.5f +- %.5f DN/e, read variance %.4f DN^2, bias %.2f DN, from %s\n",
              noise.gain_dn_per_e, noise.gain_sigma_dn_per_e, noise.read_variance_dn2,
              noise.bias_dn, noise.noise_source.c_str());
  EXPECT_EQ(noise.noise_source, "spatial differences");  // one frame of light per setting
  // An 8-bit count of a sensor with a full well of some thousand to some ten thousand electrons.
  EXPECT_GT(noise.gain_dn_per_e, 255.0 / 60000);
  EXPECT_LT(noise.gain_dn_per_e, 255.0 / 1500);
  // The darks read 0 DN nearly everywhere: the camera clips them, and that is said.
  for (const DarkFrame& dark : calibration_.darks) EXPECT_GT(dark.clipped_share, 0.99);
}

TEST_F(RealBracketTest, SevenExposuresMergeAndTheirNonlinearityIsReported) {
  const ReducedLevel level = Reduce("filter_550nm");
  Print(level.report);
  const BracketReport& report = level.report;
  ASSERT_EQ(report.exposures.size(), 7U);
  ASSERT_EQ(report.pairs.size(), 6U);
  double worst = 0;
  for (const ExposurePairCheck& pair : report.pairs) {
    EXPECT_GT(pair.pixels, 1000U);
    EXPECT_LT(pair.sigma, 0.01);
    worst = std::max(worst, std::abs(pair.ratio - 1));
  }
  // The source's frames depart by up to 6 %; far less or more would be a fault of ours.
  EXPECT_GT(worst, 0.02);
  EXPECT_LT(worst, 0.08);
  EXPECT_EQ(report.exposures.front().saturated, 0);
  EXPECT_GT(report.exposures.back().saturated, 0.8);
  EXPECT_GT(report.hot_share, 0);
  EXPECT_LT(report.hot_share, 0.001);
  EXPECT_LT(report.invalid_share, 0.01);
}

TEST_F(RealBracketTest, NoInvalidPixelHasANumber) {
  for (const auto& [series, frames] : lights_) {
    const ReducedLevel level = Reduce(series);
    const MeasuredImage& image = level.luminance.image;
    size_t invalid = 0;
    for (size_t i = 0; i < image.mask.pixels().size(); ++i) {
      const bool masked = image.mask.pixels()[i] != 0;
      invalid += masked ? 1 : 0;
      ASSERT_EQ(masked, std::isnan(image.value.pixels()[i])) << series << " pixel " << i;
      ASSERT_EQ(masked, std::isnan(image.variance.pixels()[i])) << series << " pixel " << i;
    }
    EXPECT_GT(invalid, 0U) << "hot pixels at least";
    EXPECT_EQ(image.unit, "relative");
    EXPECT_FALSE(level.luminance.flat_corrected);
  }
}

}  // namespace
}  // namespace eyebox::optics
