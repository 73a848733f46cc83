#include "optics/scatter/disk_energy.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/optics/scatter/kernels.h"

namespace eyebox::optics {
namespace {

double BruteForce(const RadialWeight& weight, const Disk& disk) {
  constexpr int kSteps = 600;
  double sum = 0;
  for (int j = 0; j < kSteps; ++j) {
    const double r = disk.radius_deg * (j + 0.5) / kSteps;
    for (int i = 0; i < kSteps; ++i) {
      const double angle = 2 * std::numbers::pi * (i + 0.5) / kSteps;
      const double s = std::hypot(disk.offset_deg + r * std::cos(angle), r * std::sin(angle));
      sum += weight.Density(s) * r;
    }
  }
  return sum * disk.radius_deg / kSteps * 2 * std::numbers::pi / kSteps;
}

TEST(DiskEnergyTest, OffTheAxisItIsTheIntegralOverTheDisk) {
  for (const ScatterKernel& kernel : AllKernels()) {
    if (kernel.core_radius_deg < 0.01) continue;  // finer than the samples of this test
    const RadialWeight weight(kernel);
    for (const Disk& disk : {Disk{0.5, 0.1}, {0.5, 0.5}, {0.5, 3}, {2, 1}}) {
      EXPECT_NEAR(EnergyInDisk(weight, disk), BruteForce(weight, disk), 3e-3)
          << disk.radius_deg << " at " << disk.offset_deg;
    }
  }
}

TEST(DiskEnergyTest, SmallSourceInTheTailIsSeenToManyDigits) {
  const RadialWeight weight({.core_radius_deg = 0.01, .tail_share = 1e-3, .tail_radius_deg = 0.5});
  const double area = std::numbers::pi * 0.01 * 0.01;
  for (const double offset : {1.0, 5.0, 20.0}) {
    const double energy = EnergyInDisk(weight, {0.01, offset});
    EXPECT_NEAR(energy / (area * weight.Density(offset)), 1, 2e-4) << offset;
  }
}

TEST(DiskEnergyTest, DiskBeyondTheReachOnAllSidesHoldsAll) {
  for (const ScatterKernel& kernel : AllKernels()) {
    EXPECT_NEAR(EnergyInDisk(RadialWeight(kernel), {70, 4}), 1, 1e-12);
  }
}

TEST(DiskEnergyTest, NothingIsSeenOfADiskBeyondTheReach) {
  const RadialWeight weight({.tail_share = 0.3, .reach_deg = 10});
  EXPECT_EQ(EnergyInDisk(weight, {1, 11}), 0);
  EXPECT_EQ(EnergyInDisk(weight, {0, 1}), 0);
}

TEST(SecondScattererTest, TwoGaussiansMakeAWiderOne) {
  const RadialWeight first({.core_radius_deg = 0.3});
  const RadialWeight second({.core_radius_deg = 0.4});
  const RadialWeight both({.core_radius_deg = 0.5});
  for (const Disk& disk : {Disk{0.2, 0}, {0.5, 0}, {1.2, 0}, {0.5, 0.7}, {0.1, 1.2}}) {
    EXPECT_NEAR(SecondScatterer(first, disk).EnergyInDisk(second), EnergyInDisk(both, disk), 1e-3)
        << disk.radius_deg << " at " << disk.offset_deg;
  }
}

TEST(SecondScattererTest, AfterASharpInstrumentItIsTheSecondAlone) {
  const RadialWeight sharp({.core_radius_deg = 1e-4});
  const RadialWeight second({.core_radius_deg = 0.1, .tail_share = 0.2, .tail_radius_deg = 2});
  for (const Disk& disk : {Disk{0.2, 0}, {2, 0}, {10, 0}, {0.2, 3}}) {
    const double alone = EnergyInDisk(second, disk);
    EXPECT_NEAR(SecondScatterer(sharp, disk).EnergyInDisk(second), alone, 1e-2 * alone)
        << disk.radius_deg << " at " << disk.offset_deg;
  }
}

}  // namespace
}  // namespace eyebox::optics
