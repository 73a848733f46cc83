// Headset and instrument told apart: the instrument on a flat display first, then both.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/fit/scatter/simulated_glare.h"

namespace eyebox::fit {
namespace {

using optics::Disk;
using optics::RadialWeight;
using optics::ScatterKernel;

const ScatterKernel kInstrument{.core = optics::CoreShape::kDisk,
                                .core_radius_deg = 0.165,
                                .tail_share = 0.03,
                                .tail_radius_deg = 1.2,
                                .tail_exponent = 3.2};
const ScatterKernel kHeadset{
    .core_radius_deg = 0.08, .tail_share = 0.2, .tail_radius_deg = 2.5, .tail_exponent = 2.6};

GlareScene Scene(double relative_sigma) {
  return {.relative_sigma = relative_sigma, .absolute_sigma = 1e-3, .small_source = false};
}

GlareSeries ThroughBoth(uint64_t seed) {
  const RadialWeight first(kInstrument), second(kHeadset);
  return SimulateGlare(
      [&](const Disk& disk) { return optics::SecondScatterer(first, disk).EnergyInDisk(second); },
      Scene(0.003), seed);
}

ScatterFit FitInstrument(double relative_sigma) {
  ScatterFitOptions options;
  options.core = optics::CoreShape::kDisk;
  const auto fit = FitScatter(SimulateGlare(kInstrument, Scene(relative_sigma), 21), options);
  EXPECT_TRUE(fit.ok()) << fit.status();
  return *fit;
}

TEST(TwoScatterersTest, HeadsetIsFoundBehindTheInstrument) {
  ScatterFitOptions options;
  options.instrument = FitInstrument(0.003).AsInstrument();
  const auto headset = FitScatter(ThroughBoth(22), options);
  ASSERT_TRUE(headset.ok()) << headset.status();
  const auto expected = TruthOf(kHeadset, Scene(0.003));
  for (int i = 0; i < kGlareParameters; ++i) {
    const Parameter& parameter = headset->parameters[i];
    EXPECT_NEAR(parameter.value, expected[i], 3 * parameter.sigma) << parameter.name;
  }
  EXPECT_LT(headset->parameters[1].sigma, 0.05);
}

TEST(TwoScatterersTest, WithoutTheFlatSeriesTheInstrumentCountsAsHeadset) {
  ScatterFitOptions options;
  options.core = optics::CoreShape::kDisk;
  const auto both = FitScatter(ThroughBoth(22), options);
  ASSERT_TRUE(both.ok());
  EXPECT_GT(both->kernel.core_radius_deg, 0.15);  // the spot's, not the headset's
  EXPECT_GT(both->kernel.tail_share, kHeadset.tail_share);
}

TEST(TwoScatterersTest, InstrumentsUncertaintyIsCarriedOn) {
  ScatterFitOptions options;
  options.instrument = FitInstrument(0.02).AsInstrument();
  const auto uncertain = FitScatter(ThroughBoth(22), options);
  options.instrument->covariance = {};
  const auto certain = FitScatter(ThroughBoth(22), options);
  ASSERT_TRUE(uncertain.ok() && certain.ok());
  EXPECT_EQ(uncertain->kernel.tail_share, certain->kernel.tail_share);
  EXPECT_GT(uncertain->parameters[1].sigma, 1.1 * certain->parameters[1].sigma);
}

}  // namespace
}  // namespace eyebox::fit
