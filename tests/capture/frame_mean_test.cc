#include "capture/run/frame_mean.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <vector>

#include "capture/base/random.h"

namespace eyebox::capture {
namespace {

FrameMean MeanOfPixels(const std::vector<uint16_t>& pixels, int width) {
  return MeanOf(
      FrameView{.pixels_dn = pixels, .size = {width, static_cast<int>(pixels.size()) / width}});
}

TEST(FrameMean, IsTheMeanOfAllPixelsOfASmallFrame) {
  std::vector<uint16_t> pixels(35);
  std::iota(pixels.begin(), pixels.end(), uint16_t{10});
  EXPECT_DOUBLE_EQ(MeanOfPixels(pixels, 7).mean_dn, 27);
}

TEST(FrameMean, HoldsTheLargestCounts) {
  const std::vector<uint16_t> pixels(size_t{4000} * 3000, 65535);
  const FrameMean mean = MeanOfPixels(pixels, 4000);
  EXPECT_DOUBLE_EQ(mean.mean_dn, 65535);
  EXPECT_GT(mean.sigma_dn, 0) << "quantisation is left";
}

TEST(FrameMean, SigmaIsThatOfTheNoise) {
  RandomStream random({5});
  double squares = 0;
  double sigma = 0;
  constexpr int kFrames = 400;
  for (int frame = 0; frame < kFrames; ++frame) {
    std::vector<uint16_t> pixels(40 * 30);
    for (uint16_t& pixel : pixels) pixel = static_cast<uint16_t>(1000 + random.Below(101));
    const FrameMean mean = MeanOfPixels(pixels, 40);
    squares += std::pow(mean.mean_dn - 1050, 2);
    sigma += mean.sigma_dn / kFrames;
  }
  EXPECT_NEAR(std::sqrt(squares / kFrames), sigma, 0.12 * sigma);  // 3.4 sigma of 400 frames
}

TEST(FrameMean, AMosaicIsNoNoise) {
  std::vector<uint16_t> pixels(40 * 30);
  for (size_t i = 0; i < pixels.size(); ++i) pixels[i] = i % 2 == 0 ? 100 : 900;
  EXPECT_LT(MeanOfPixels(pixels, 40).sigma_dn, 0.01);
}

TEST(FrameMean, WithoutPixelsOrOfOneColumnHasNoScatter) {
  EXPECT_EQ(MeanOf(FrameView{}).mean_dn, 0);
  EXPECT_DOUBLE_EQ(MeanOfPixels({4, 6}, 1).mean_dn, 5);
}

TEST(FrameMean, OfFramesCountsTheirScatterWhereItIsLarger) {
  const FrameMean steady = MeanOf({{10, 0.2, 0.2}, {10, 0.2, 0.2}});
  EXPECT_DOUBLE_EQ(steady.mean_dn, 10);
  EXPECT_DOUBLE_EQ(steady.sigma_dn, 0.2 / std::sqrt(2.0));
  const FrameMean flickering = MeanOf({{9, 0.2, 0.2}, {11, 0.2, 0.2}});
  EXPECT_DOUBLE_EQ(flickering.mean_dn, 10);
  EXPECT_DOUBLE_EQ(flickering.sigma_dn, 1);  // sqrt(2) / sqrt(2)
  EXPECT_DOUBLE_EQ(MeanOf({{7, 0.3, 0.3}}).sigma_dn, 0.3);
}

}  // namespace
}  // namespace eyebox::capture
