#include "optics/scatter/kernel_grid.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/optics/scatter/kernels.h"

namespace eyebox::optics {
namespace {

double MeanDensity(const RadialWeight& weight, double pitch, int x, int y) {
  constexpr int kSamples = 400;
  double sum = 0;
  for (int j = 0; j < kSamples; ++j) {
    for (int i = 0; i < kSamples; ++i) {
      sum += weight.Density(
          std::hypot(x - 0.5 + (i + 0.5) / kSamples, y - 0.5 + (j + 0.5) / kSamples) * pitch);
    }
  }
  return sum / (kSamples * kSamples) * pitch * pitch;
}

TEST(KernelGridTest, PixelsHoldTheIntegralOverTheirArea) {
  for (const ScatterKernel& kernel : AllKernels()) {
    if (kernel.core_radius_deg < 0.01) continue;  // finer than the samples of this test
    const RadialWeight weight(kernel);
    const Image<float> grid = SampleKernel(weight, 0.1, {64, 40});
    for (const auto& [x, y] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 7}, {20, 3}, {30, 35}}) {
      const double expected = MeanDensity(weight, 0.1, x, y);
      // A disk's edge within the pixel is what both sums see least well.
      EXPECT_NEAR(grid.at(x, y), expected, 2e-3 * expected + 2e-4 * grid.at(0, 0))
          << x << ", " << y;
    }
  }
}

TEST(KernelGridTest, GridThatHoldsTheReachSumsToOne) {
  for (ScatterKernel kernel : AllKernels()) {
    kernel.reach_deg = 5;
    for (const double pitch : {0.02, 0.1, 3.0}) {
      const int size = static_cast<int>(5 / pitch) + 2;
      const Image<float> grid = SampleKernel(RadialWeight(kernel), pitch, {size, size});
      EXPECT_NEAR(SumOverGrid(grid), 1, 1e-6) << pitch;
    }
  }
}

TEST(KernelGridTest, CoreNarrowerThanAPixelKeepsItsEnergy) {
  const ScatterKernel kernel{.core_radius_deg = 1e-5, .tail_share = 0.2, .tail_radius_deg = 4};
  const Image<float> grid = SampleKernel(RadialWeight(kernel), 0.05, {200, 200});
  EXPECT_NEAR(grid.at(0, 0), 0.8, 1e-3);
  EXPECT_LT(grid.at(1, 0), 1e-3);
}

// What leaves the rectangle is what the sum lacks.
TEST(KernelGridTest, GridWithinTheReachSumsToTheEnergyThatFallsOnIt) {
  const ScatterKernel kernel{.tail_share = 0.4, .tail_radius_deg = 3, .tail_exponent = 2};
  const RadialWeight weight(kernel);
  const double sum = SumOverGrid(SampleKernel(weight, 0.1, {100, 100}));
  EXPECT_GT(sum, weight.EnergyWithin(9.95));
  EXPECT_LT(sum, weight.EnergyWithin(9.95 * std::sqrt(2)));
}

TEST(KernelGridTest, OnePixelIsEnough) {
  const Image<float> grid = SampleKernel(RadialWeight({.core_radius_deg = 0.01}), 0.1, {1, 1});
  EXPECT_NEAR(SumOverGrid(grid), 1, 1e-5);
}

}  // namespace
}  // namespace eyebox::optics
