#include "optics/scatter/scatter_kernel.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "tests/optics/scatter/kernels.h"

namespace eyebox::optics {
namespace {

using ::testing::HasSubstr;

// Trapezoid in log radius, from so far in that the rest is the density times the area.
double IntegrateDensity(const RadialWeight& weight, double from, double to) {
  constexpr int kSteps = 40000;
  double sum = 0;
  for (int i = 0; i <= kSteps; ++i) {
    const double r = from * std::pow(to / from, static_cast<double>(i) / kSteps);
    sum += (i == 0 || i == kSteps ? 0.5 : 1) * weight.Density(r) * r * r;
  }
  return 2 * std::numbers::pi * sum * std::log(to / from) / kSteps;
}

TEST(ScatterKernelTest, EnergyIsTheIntegralOfTheDensity) {
  for (const ScatterKernel& kernel : AllKernels()) {
    ASSERT_TRUE(kernel.Validate().ok()) << kernel.Validate();
    const RadialWeight weight(kernel);
    for (const double radius : {0.05, 0.4, 3.0, 19.0}) {
      const double inner = kernel.core_radius_deg * 1e-3;
      const double expected = weight.EnergyWithin(inner) + IntegrateDensity(weight, inner, radius);
      EXPECT_NEAR(weight.EnergyWithin(radius), expected, 3e-4) << "radius " << radius;
    }
  }
}

TEST(ScatterKernelTest, AllEnergyLiesWithinTheReach) {
  for (const ScatterKernel& kernel : AllKernels()) {
    const RadialWeight weight(kernel);
    EXPECT_EQ(weight.EnergyWithin(0), 0);
    EXPECT_EQ(weight.EnergyWithin(kernel.reach_deg), 1);
    EXPECT_NEAR(weight.EnergyWithin(kernel.reach_deg * (1 - 1e-9)), 1, 1e-8);
    EXPECT_EQ(weight.EnergyWithin(1e9), 1);
    EXPECT_EQ(weight.Density(kernel.reach_deg * 1.001), 0);
  }
}

TEST(ScatterKernelTest, TailFallsWithItsExponent) {
  for (const TailShape tail : {TailShape::kMoffat, TailShape::kPowerLaw}) {
    const RadialWeight weight(
        {.tail = tail, .tail_share = 0.1, .tail_radius_deg = 0.01, .tail_exponent = 2.7});
    EXPECT_NEAR(std::log2(weight.Density(10) / weight.Density(20)), 2.7, 1e-5);
  }
}

TEST(ScatterKernelTest, NonsenseIsRefusedByName) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto message = [](const ScatterKernel& kernel) {
    EXPECT_EQ(kernel.Validate().code(), absl::StatusCode::kInvalidArgument);
    return std::string(kernel.Validate().message());
  };
  EXPECT_THAT(message({.core_radius_deg = 0}), HasSubstr("core_radius_deg"));
  EXPECT_THAT(message({.core_radius_deg = 70}), HasSubstr("within the reach"));
  EXPECT_THAT(message({.tail_share = nan}), HasSubstr("tail_share"));
  EXPECT_THAT(message({.tail_share = 0.6, .pedestal_share = 0.4}), HasSubstr("to the core"));
  EXPECT_THAT(message({.tail_exponent = 0}), HasSubstr("tail_exponent"));
  EXPECT_THAT(message({.reach_deg = std::numeric_limits<double>::infinity()}),
              HasSubstr("reach_deg"));
}

}  // namespace
}  // namespace eyebox::optics
