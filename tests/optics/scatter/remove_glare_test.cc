#include "optics/scatter/remove_glare.h"

#include <gtest/gtest.h>

#include <cmath>

#include "optics/scatter/spread_light.h"
#include "tests/optics/scatter/luminance_images.h"

namespace eyebox::optics {
namespace {

constexpr int kSize = 96;
constexpr double kPitchDeg = 0.25;
constexpr double kRelativeSigma = 0.05;

ScatterKernel Lens(double tail_share) {
  return {CoreShape::kGaussian, TailShape::kMoffat, 0.1, tail_share, 1.5, 3, 0, 10};
}

// 100 on a dark surround, with a black square in the middle.
Image<float> Scene() {
  Image<float> scene({kSize, kSize}, 100.0F);
  for (int y = 40; y < 56; ++y) {
    for (int x = 40; x < 56; ++x) scene.at(x, y) = 0;
  }
  return scene;
}

GlareRemoval RemoveWith(double tail_share, const Image<float>& seen, double noise) {
  const LuminanceImage reading = WithNoise(seen, noise, 0, 5);
  const auto removal =
      RemoveGlare(reading, {Lens(tail_share), kRelativeSigma, kPitchDeg, Surround::kDark});
  EXPECT_TRUE(removal.ok()) << removal.status();
  return *removal;
}

// A lens that scatters one standard uncertainty less than is known of it.
TEST(RemoveGlareTest, AWrongTailIsOffByTheSharedSigmaEverywhere) {
  const auto seen = SpreadLight(Scene(), kPitchDeg, Lens(0.1));
  ASSERT_TRUE(seen.ok());
  const GlareRemoval right = RemoveWith(0.1, *seen, 1e-3);
  const GlareRemoval wrong = RemoveWith(0.1 * (1 + kRelativeSigma), *seen, 1e-3);
  for (const auto& [x, y] : {std::pair{48, 48}, {44, 50}, {20, 20}, {70, 48}, {4, 90}}) {
    const double error =
        wrong.luminance.image.value.at(x, y) - right.luminance.image.value.at(x, y);
    const double sigma = right.luminance.scatter_sigma.at(x, y);
    EXPECT_NEAR(-error / sigma, 1, 0.35) << x << ", " << y;
  }
  EXPECT_GT(right.luminance.scatter_sigma.at(48, 48), 0.05);
}

TEST(RemoveGlareTest, NoiseAndWhatAllPixelsShareAreApart) {
  const auto seen = SpreadLight(Scene(), kPitchDeg, Lens(0.1));
  ASSERT_TRUE(seen.ok());
  const GlareRemoval removal = RemoveWith(0.1, *seen, 0.2);
  double squares = 0;
  int count = 0;
  for (int y = 60; y < 92; ++y) {
    for (int x = 4; x < 92; ++x) {
      const double error = removal.luminance.image.value.at(x, y) - 100;
      squares += error * error / removal.luminance.image.variance.at(x, y);
      ++count;
    }
  }
  EXPECT_NEAR(std::sqrt(squares / count), 1, 0.1);
  const Image<float> whole = VarianceWithScatter(removal.luminance);
  const double shared = removal.luminance.ScatterSigma(48 * kSize + 48);
  EXPECT_NEAR(whole.at(48, 48), removal.luminance.image.variance.at(48, 48) + shared * shared,
              1e-6);
  double shared_squares = 0;
  double variances = 0;
  for (size_t i = 0; i < whole.pixels().size(); ++i) {
    shared_squares += std::pow(removal.luminance.ScatterSigma(i), 2);
    variances += removal.luminance.image.variance.pixels()[i];
  }
  EXPECT_NEAR(removal.figures.common_share, shared_squares / variances, 1e-5);
  EXPECT_GT(removal.figures.common_share, 0.1);
  EXPECT_LT(removal.figures.variance_share, 0.3);
}

TEST(RemoveGlareTest, MaskedPixelsStayWithoutAValue) {
  LuminanceImage reading = WithNoise(Scene(), 0.2, 0, 6);
  reading.image.mask.at(10, 10) = kSaturated;
  BlankMaskedPixels(reading.image);
  const auto removal =
      RemoveGlare(reading, {Lens(0.1), kRelativeSigma, kPitchDeg, Surround::kContinued});
  ASSERT_TRUE(removal.ok()) << removal.status();
  EXPECT_TRUE(std::isnan(removal->luminance.image.value.at(10, 10)));
  EXPECT_TRUE(std::isnan(removal->luminance.scatter_sigma.at(10, 10)));
}

}  // namespace
}  // namespace eyebox::optics
