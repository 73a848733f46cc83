#include "capture/camera/sim/optics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace eyebox::capture {
namespace {

constexpr ImageSize kSize = {.width_px = 160, .height_px = 120};

double Sum(const Image<double>& image) {
  return std::accumulate(image.pixels().begin(), image.pixels().end(), 0.0);
}

// A brute-force convolution with the border repeated, at one pixel.
double ConvolvedAt(const Image<double>& scene, const Image<double>& kernel, int x, int y) {
  const int radius = kernel.size().width_px / 2;
  double sum = 0;
  for (int dy = -radius; dy <= radius; ++dy) {
    for (int dx = -radius; dx <= radius; ++dx) {
      const int from_x = std::clamp(x - dx, 0, scene.size().width_px - 1);
      const int from_y = std::clamp(y - dy, 0, scene.size().height_px - 1);
      sum += kernel.at(dx + radius, dy + radius) * scene.at(from_x, from_y);
    }
  }
  return sum;
}

TEST(ScatterKernel, SumsToOne) {
  EXPECT_NEAR(Sum(ScatterKernel({})), 1, 1e-12);
  EXPECT_NEAR(Sum(ScatterKernel({.core_sigma_px = 0, .tail_weight = 0.3})), 1, 1e-12);
  EXPECT_NEAR(Sum(ScatterKernel({.core_sigma_px = 2, .tail_weight = 0})), 1, 1e-12);
}

TEST(ScatterKernel, PutsTheTailsShareOutsideTheCore) {
  const ScatterParameters parameters = {.core_sigma_px = 0.5, .tail_weight = 0.02};
  const Image<double> kernel = ScatterKernel(parameters);
  const int radius = kernel.size().width_px / 2;
  double beyond_core = 0;
  for (int y = -radius; y <= radius; ++y) {
    for (int x = -radius; x <= radius; ++x) {
      if (x * x + y * y > 16) beyond_core += kernel.at(x + radius, y + radius);
    }
  }
  EXPECT_LT(beyond_core, 0.02);
  EXPECT_GT(beyond_core, 0.019);
}

TEST(Scatter, ConservesTheLightOfAPoint) {
  Image<double> scene({.width_px = 201, .height_px = 201}, 0.0);
  scene.at(100, 100) = 1000;
  const auto scattered = Scatter(scene, {});
  ASSERT_TRUE(scattered.ok()) << scattered.status();
  EXPECT_NEAR(Sum(*scattered), 1000, 1e-8);
  EXPECT_LT(scattered->at(100, 100), 1000);
  EXPECT_GT(scattered->at(160, 100), 0);
}

TEST(Scatter, LeavesAUniformFieldAsItIs) {
  const auto scattered = Scatter(Image<double>(kSize, 25.0), {});
  ASSERT_TRUE(scattered.ok()) << scattered.status();
  for (const double value : scattered->pixels()) EXPECT_NEAR(value, 25, 1e-10);
}

TEST(Scatter, AgreesWithADirectSum) {
  Image<double> scene({.width_px = 48, .height_px = 37}, 0.2);
  for (int y = 0; y < 37; ++y) {
    for (int x = 0; x < 48; ++x) scene.at(x, y) += (x * 7 + y * 13) % 11;
  }
  const ScatterParameters parameters = {.core_sigma_px = 0.8,
                                        .tail_weight = 0.1,
                                        .tail_scale_px = 5,
                                        .tail_beta = 1.5,
                                        .tail_radius_px = 30};
  const auto scattered = Scatter(scene, parameters);
  ASSERT_TRUE(scattered.ok()) << scattered.status();
  const Image<double> kernel = ScatterKernel(parameters);
  for (const auto& [x, y] : {std::pair{0, 0}, {47, 36}, {20, 11}, {3, 30}}) {
    EXPECT_NEAR(scattered->at(x, y), ConvolvedAt(scene, kernel, x, y), 1e-12);
  }
}

TEST(Scatter, SwitchedOffChangesNothing) {
  Image<double> scene(kSize, 1.0);
  scene.at(3, 4) = 7;
  const auto scattered = Scatter(scene, {.core_sigma_px = 0, .tail_weight = 0});
  ASSERT_TRUE(scattered.ok());
  EXPECT_TRUE(std::ranges::equal(scattered->pixels(), scene.pixels()));
}

TEST(Vignetting, IsTheFourthPowerOfTheCosine) {
  const PinholeGeometry geometry = {
      .focal_length_px = 219.8, .principal_x_px = 79.5, .principal_y_px = 59.5};
  const Image<double> vignetting = Vignetting(geometry, kSize);
  for (const auto& [x, y] : {std::pair{0, 0}, {159, 60}, {80, 59}, {120, 7}}) {
    const double angle_rad = std::atan(std::hypot(x - 79.5, y - 59.5) / 219.8);
    EXPECT_NEAR(vignetting.at(x, y), std::pow(std::cos(angle_rad), 4), 1e-14);
  }
  EXPECT_LT(vignetting.at(0, 0), 0.7);
}

}  // namespace
}  // namespace eyebox::capture
