#include "fit/scatter/fit_scatter.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/fit/scatter/simulated_glare.h"

namespace eyebox::fit {
namespace {

using optics::CoreShape;
using optics::ScatterKernel;
using optics::TailShape;
using ::testing::HasSubstr;

ScatterKernel Truth(double tail_share) {
  return {.core_radius_deg = 0.06,
          .tail_share = tail_share,
          .tail_radius_deg = 0.7,
          .tail_exponent = 2.8};
}

class TailShareTest : public ::testing::TestWithParam<double> {};

TEST_P(TailShareTest, KernelIsRecoveredWithinThreeSigma) {
  const ScatterKernel truth = Truth(GetParam());
  for (uint64_t seed = 1; seed <= 5; ++seed) {
    const auto fit = FitScatter(SimulateGlare(truth, {}, seed));
    ASSERT_TRUE(fit.ok()) << fit.status();
    const auto expected = TruthOf(truth, {});
    for (int i = 0; i < kGlareParameters; ++i) {
      const Parameter& parameter = fit->parameters[i];
      // 5 seeds, the same in all shares: the two luminances have room for one unlikely draw.
      const double sigmas = i < kKernelParameters ? 3 : 4.5;
      EXPECT_NEAR(parameter.value, expected[i], sigmas * parameter.sigma)
          << parameter.name << ", seed " << seed;
    }
    EXPECT_LT(fit->parameters[1].sigma, 0.1 * GetParam());  // and it is worth knowing
    EXPECT_LT(fit->chi_square, fit->degrees_of_freedom + 4 * std::sqrt(2 * 27));
    EXPECT_TRUE(fit->open.empty()) << fit->identifiability;
    EXPECT_THAT(fit->termination, HasSubstr("converged"));
  }
}

INSTANTIATE_TEST_SUITE_P(Shares, TailShareTest, ::testing::Values(0.001, 0.01, 0.05, 0.1, 0.3));

TEST(FitScatterTest, EveryShapeIsRecovered) {
  for (const CoreShape core : {CoreShape::kGaussian, CoreShape::kDisk}) {
    for (const TailShape tail : {TailShape::kMoffat, TailShape::kPowerLaw}) {
      ScatterKernel truth = Truth(0.08);
      truth.core = core;
      truth.tail = tail;
      truth.core_radius_deg = 0.165;
      truth.pedestal_share = 0.02;
      ScatterFitOptions options;
      options.core = core;
      options.tail = tail;
      options.pedestal = true;
      const auto fit = FitScatter(SimulateGlare(truth, {}, 3), options);
      ASSERT_TRUE(fit.ok()) << fit.status();
      const auto expected = TruthOf(truth, {});
      for (int i = 0; i < kGlareParameters; ++i) {
        EXPECT_NEAR(fit->parameters[i].value, expected[i], 3.5 * fit->parameters[i].sigma)
            << fit->parameters[i].name;
      }
    }
  }
}

TEST(FitScatterTest, SigmasAreThoseOfRepeatedSeries) {
  const ScatterKernel truth = Truth(0.05);
  const auto expected = TruthOf(truth, {});
  constexpr int kSeries = 60;
  std::array<double, kGlareParameters> squares{};
  for (uint64_t seed = 0; seed < kSeries; ++seed) {
    const auto fit = FitScatter(SimulateGlare(truth, {}, 1000 + seed));
    ASSERT_TRUE(fit.ok()) << fit.status();
    for (int i = 0; i < kGlareParameters; ++i) {
      if (fit->parameters[i].sigma == 0) continue;
      const double pull = (fit->parameters[i].value - expected[i]) / fit->parameters[i].sigma;
      squares[i] += pull * pull / kSeries;
    }
  }
  for (const int i : {0, 1, 2, 3, 5, 6}) EXPECT_NEAR(std::sqrt(squares[i]), 1, 0.25) << i;
  EXPECT_EQ(squares[4], 0);  // the pedestal was held
}

TEST(FitScatterTest, HeldParametersStay) {
  ScatterFitOptions options;
  options.tail_exponent = 2.8;
  options.bright_luminance = 59;
  options.background_luminance = 0.19;
  const auto fit = FitScatter(SimulateGlare(Truth(0.05), {}, 2), options);
  ASSERT_TRUE(fit.ok()) << fit.status();
  EXPECT_NEAR(fit->kernel.tail_exponent, 2.8, 1e-12);
  EXPECT_NEAR(fit->bright_luminance, 59, 1e-10);
  EXPECT_EQ(fit->parameters[3].sigma, 0);
  EXPECT_EQ(fit->parameters[5].sigma, 0);
  const auto free = FitScatter(SimulateGlare(Truth(0.05), {}, 2));
  ASSERT_TRUE(free.ok());
  EXPECT_LT(fit->parameters[2].sigma, free->parameters[2].sigma);
  EXPECT_EQ(fit->degrees_of_freedom, free->degrees_of_freedom + 3);
}

// The readings stop long before the tail ends: its radius and slope trade against each other.
TEST(FitScatterTest, WhatTheReadingsLeaveOpenIsSaid) {
  GlareSeries series = SimulateGlare(
      Truth(0.02), {.relative_sigma = 0.02, .small_source = false, .black_disks = false}, 4);
  std::erase_if(series.readings, [](const GlareReading& r) { return r.diameter_deg > 2; });
  const auto fit = FitScatter(series);
  ASSERT_TRUE(fit.ok()) << fit.status();
  ASSERT_FALSE(fit->open.empty());
  EXPECT_THAT(fit->identifiability, HasSubstr("tail_"));
  EXPECT_GT(fit->open.front().sigma, 0.5);
  EXPECT_EQ(fit->open.front().direction[4], 0);
  double length = 0;
  for (const double component : fit->open.front().direction) length += component * component;
  EXPECT_NEAR(length, 1, 1e-9);
  for (const Parameter& parameter : fit->parameters) {
    EXPECT_TRUE(std::isfinite(parameter.value) && std::isfinite(parameter.sigma));
  }
}

TEST(FitScatterTest, WithoutATailItsShareIsZeroWithinItsSigma) {
  const auto fit = FitScatter(SimulateGlare(Truth(0), {}, 5));
  ASSERT_TRUE(fit.ok()) << fit.status();
  EXPECT_NEAR(fit->kernel.tail_share, 0, 3 * fit->parameters[1].sigma + 1e-3);
  EXPECT_LT(fit->kernel.tail_share, 2e-3);
  EXPECT_NEAR(fit->kernel.core_radius_deg, 0.06, 4 * fit->parameters[0].sigma);
  EXPECT_FALSE(fit->open.empty());
  for (const double value : fit->covariance) EXPECT_TRUE(std::isfinite(value));
}

TEST(FitScatterTest, LuminanceOfAnyUnitIsFittedAlike) {
  for (const double unit : {1e-5, 1.0, 1e4}) {
    const auto fit = FitScatter(SimulateGlare(
        Truth(0.05),
        {.bright = 59 * unit, .background = 0.19 * unit, .absolute_sigma = 1e-4 * unit}, 6));
    ASSERT_TRUE(fit.ok()) << fit.status();
    EXPECT_NEAR(fit->kernel.tail_share, 0.05, 3 * fit->parameters[1].sigma);
    EXPECT_NEAR(fit->bright_luminance / unit, 59, 3 * fit->parameters[5].sigma / unit);
  }
}

TEST(FitScatterTest, ReadingsWorseThanTheirSigmasWidenTheSigmas) {
  GlareSeries series = SimulateGlare(Truth(0.05), {.relative_sigma = 0.03}, 7);
  const auto honest = FitScatter(series);
  for (GlareReading& reading : series.readings) reading.luminance_sigma /= 10;
  const auto boastful = FitScatter(series);
  ASSERT_TRUE(honest.ok() && boastful.ok());
  EXPECT_GT(boastful->chi_square, 30 * boastful->degrees_of_freedom);
  EXPECT_NEAR(boastful->parameters[1].sigma / honest->parameters[1].sigma, 1, 0.5);
}

TEST(FitScatterTest, BadReadingsAreNamed) {
  const GlareSeries good = SimulateGlare(Truth(0.05), {}, 8);
  const auto message = [&](auto&& spoil) {
    GlareSeries series = good;
    spoil(series);
    const auto fit = FitScatter(series);
    EXPECT_EQ(fit.status().code(), absl::StatusCode::kInvalidArgument);
    return std::string(fit.status().message());
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(message([&](GlareSeries& s) { s.readings[2].luminance = nan; }),
              HasSubstr("simulated, glare reading 3"));
  EXPECT_THAT(message([](GlareSeries& s) { s.readings[0].luminance_sigma = 0; }),
              HasSubstr("sigma"));
  EXPECT_THAT(message([](GlareSeries& s) { s.readings[1].diameter_deg = -1; }),
              HasSubstr("angles"));
  EXPECT_THAT(message([](GlareSeries& s) { s.readings.resize(3); }), HasSubstr("at least 4"));
  EXPECT_THAT(message([](GlareSeries& s) {
                for (GlareReading& r : s.readings) r.luminance = 0;
              }),
              HasSubstr("no glare reading is above 0"));
}

TEST(FitScatterTest, FewerReadingsThanParametersAreRejected) {
  GlareSeries series = SimulateGlare(Truth(0.05), {}, 9);
  series.readings.resize(5);
  EXPECT_EQ(FitScatter(series).status().code(), absl::StatusCode::kFailedPrecondition);
}

}  // namespace
}  // namespace eyebox::fit
