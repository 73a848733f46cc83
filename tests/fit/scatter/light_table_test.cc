// Sums over a table of radii against the integrals that they stand for.
#include "fit/scatter/light_table.h"

#include <gtest/gtest.h>

#include <cmath>

#include "fit/scatter/glare_model.h"
#include "tests/fit/scatter/simulated_glare.h"
#include "tests/optics/scatter/kernels.h"

namespace eyebox::fit {
namespace {

using optics::EnergyInDisk;
using optics::RadialWeight;
using optics::ScatterKernel;

constexpr double kFieldRadiusDeg = 12;

GlareSeries SeriesOf(const std::vector<optics::Disk>& disks) {
  GlareSeries series{{}, kFieldRadiusDeg, "cd/m2", "simulated"};
  for (const auto& [radius, offset] : disks) {
    series.readings.push_back({GlarePattern::kBrightDisk, 2 * radius, offset, 1, 0.01});
  }
  return series;
}

ScatterFitOptions OptionsFor(const ScatterKernel& kernel) {
  ScatterFitOptions options;
  options.core = kernel.core;
  options.tail = kernel.tail;
  options.reach_deg = kernel.reach_deg;
  return options;
}

double Through(const ScatterKernel& kernel, const PartLight& light) {
  return kernel.CoreShare() * light.core.energy + kernel.tail_share * light.tail.energy +
         kernel.pedestal_share * light.pedestal;
}

const std::vector<optics::Disk> kDisks = {{0.05, 0},  {0.5, 0}, {3, 0},   {0.2, 0.07},
                                          {0.5, 0.1}, {2, 1},   {0.5, 3}, {0.2, 6}};

TEST(LightTable, DisksAndFieldsAreThoseOfTheIntegrals) {
  for (const ScatterKernel& kernel : optics::AllKernels()) {
    const RadialWeight weight(kernel);
    const auto light = LightTable::Of(SeriesOf(kDisks), OptionsFor(kernel)).LightFor(kernel);
    ASSERT_EQ(light.size(), kDisks.size());
    // A core with an edge and a tail with a kink are not smooth between the nodes of either sum.
    const bool smooth =
        kernel.core == optics::CoreShape::kGaussian && kernel.tail == optics::TailShape::kMoffat;
    for (size_t i = 0; i < kDisks.size(); ++i) {
      const double disk = EnergyInDisk(weight, kDisks[i]);
      const double field = EnergyInDisk(weight, {kFieldRadiusDeg, kDisks[i].offset_deg});
      EXPECT_NEAR(Through(kernel, light[i].disk), disk, smooth ? 1e-6 : 2e-4) << i;
      EXPECT_NEAR(Through(kernel, light[i].rest), field - disk, smooth ? 1e-6 : 2e-4) << i;
    }
  }
}

TEST(LightTable, SmallDiskInTheTailIsSeenToManyDigits) {
  for (const double exponent : {2.2, 3.0, 6.0}) {
    const ScatterKernel kernel{
        .core_radius_deg = 0.05, .tail_share = 1e-3, .tail_exponent = exponent, .reach_deg = 30};
    const std::vector<optics::Disk> disks = {{0.05, 1}, {0.2, 5}, {0.1, 20}};
    const auto light = LightTable::Of(SeriesOf(disks), OptionsFor(kernel)).LightFor(kernel);
    for (size_t i = 0; i < disks.size(); ++i) {
      const double disk = EnergyInDisk(RadialWeight(kernel), disks[i]);
      EXPECT_NEAR(Through(kernel, light[i].disk) / disk, 1, 1e-4) << exponent << ", disk " << i;
    }
  }
}

TEST(LightTable, AnUnevenFieldIsASumOfDisks) {
  constexpr int kSteps = 4000;
  const ScatterKernel kernel{.core_radius_deg = 0.1, .tail_share = 0.3, .reach_deg = 20};
  GlareSeries series = SeriesOf({{3, 0}, {3, 0.5}, {3, 4}});
  for (int k = 1; k <= 9; ++k) series.field.push_back({static_cast<double>(k), 1 - 0.006 * k * k});
  const RadialWeight weight(kernel);
  const auto light = LightTable::Of(series, OptionsFor(kernel)).LightFor(kernel);
  for (size_t i = 0; i < light.size(); ++i) {
    // Disks of falling luminance laid over each other.
    const auto within = [&](double radius) {
      double sum = 0;
      for (int k = 0; k < kSteps; ++k) {
        const double edge = radius * (k + 1) / kSteps;
        const double next = k + 1 < kSteps ? series.FieldAt(radius * (k + 1.5) / kSteps) : 0;
        const double step = series.FieldAt(radius * (k + 0.5) / kSteps) - next;
        sum += step * EnergyInDisk(weight, {edge, series.readings[i].offset_deg});
      }
      return sum;
    };
    const double disk = within(3);
    EXPECT_NEAR(Through(kernel, light[i].disk), disk, 2e-4) << i;
    EXPECT_NEAR(Through(kernel, light[i].rest), within(9) - disk, 2e-4) << i;
  }
}

TEST(GlareSeries, FieldIsStraightOverTheSquareOfTheRadius) {
  GlareSeries series;
  EXPECT_EQ(series.FieldAt(7), 1);
  // Means of 2 - r^2 / 50 over each ring.
  series.field = {{2, 1.96}, {4, 1.8}, {6, 1.48}};
  for (const double r : {0.0, 1.0, 3.0, 5.0}) {
    EXPECT_NEAR(series.FieldAt(r), 1 - r * r / 100, 1e-12) << r;
  }
  EXPECT_NEAR(series.FieldAt(30), 1.48 / 2, 1e-12);  // goes on as in the outermost ring
}

TEST(LightTable, BehindAnInstrumentItIsThatOfTheSecondScatterer) {
  const ScatterKernel instrument{.core_radius_deg = 0.2, .tail_share = 0.1, .reach_deg = 20};
  const ScatterKernel kernel{.core_radius_deg = 0.1, .tail_share = 0.2, .reach_deg = 20};
  ScatterFitOptions options = OptionsFor(kernel);
  options.instrument = KnownScatter{instrument, {}};
  const auto light = LightTable::Of(SeriesOf(kDisks), options).LightFor(kernel);
  const RadialWeight first(instrument), second(kernel);
  for (size_t i = 0; i < kDisks.size(); ++i) {
    EXPECT_NEAR(Through(kernel, light[i].disk),
                optics::SecondScatterer(first, kDisks[i]).EnergyInDisk(second), 1e-6);
  }
}

TEST(GlareModel, SlopesAreThoseOfDifferences) {
  constexpr double kStep = 1e-4;
  for (const ScatterKernel& kernel : optics::AllKernels()) {
    if (kernel.tail_share == 0 || kernel.core_radius_deg < 0.01) continue;
    ScatterFitOptions options = OptionsFor(kernel);
    options.pedestal = true;
    GlareSeries series = SeriesOf(kDisks);
    series.readings[1].pattern = GlarePattern::kBlackDisk;
    const GlareModel model(series, options);
    const GlareCoordinates at = model.CoordinatesOf(TruthOf(kernel, {}));
    const GlareEvaluation found = model.Evaluate(at);
    for (int j = 0; j < kGlareParameters; ++j) {
      GlareCoordinates above = at, below = at;
      above[j] += kStep;
      below[j] -= kStep;
      const auto high = model.Residuals(above), low = model.Residuals(below);
      for (size_t i = 0; i < high.size(); ++i) {
        // A disk core has a kink where its edge passes a node.
        const double tolerance = kernel.core == optics::CoreShape::kDisk && j == kCoreRadius
                                     ? 0.02 * std::abs(found.residuals[i]) + 0.1
                                     : 1e-6 * std::abs(found.residuals[i]) + 1e-5;
        EXPECT_NEAR(found.jacobian[i * kGlareParameters + j], (high[i] - low[i]) / (2 * kStep),
                    tolerance)
            << kGlareNames[j] << ", reading " << i << ", exponent " << kernel.tail_exponent;
      }
    }
  }
}

}  // namespace
}  // namespace eyebox::fit
