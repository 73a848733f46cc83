#include "fit/cube/proportionality.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "fit/cube/places.h"

namespace eyebox::fit {
namespace {

TEST(ProportionalityTest, DeparturesAreThoseOfTheUnweightedLine) {
  // By hand: slope (1*1 + 2*2.2) / 5 = 1.08.
  const std::vector<RenderedReading> readings = {{{1}, 1, 0.1}, {{2}, 2.2, 0.2}};
  const auto line = FitLineThroughOrigin(readings, "t");
  ASSERT_TRUE(line.ok()) << line.status();
  EXPECT_NEAR(line->slopes[0], 1.08, 1e-14);
  EXPECT_NEAR(line->slope_sigmas[0], std::hypot(0.1 * 0.2, 0.2 * 0.4), 1e-14);
  EXPECT_NEAR(line->departures[0].departure_of_maximum, -0.08 / 2.2, 1e-14);
  EXPECT_NEAR(line->departures[0].departure_of_value, -0.08 / 1.08, 1e-14);
  // L0 - slope = 0.8 L0 - 0.4 L1.
  EXPECT_NEAR(line->departures[0].departure_of_maximum_sigma, std::hypot(0.08, 0.08) / 2.2, 1e-14);
  EXPECT_NEAR(line->worst_of_maximum, 0.08 / 2.2, 1e-14);
}

TEST(ProportionalityTest, ThreePrimariesHaveThreeSlopes) {
  std::vector<RenderedReading> readings;
  for (double r : {0.0, 1.0}) {
    for (double g : {0.0, 1.0}) {
      for (double b : {0.0, 1.0}) readings.push_back({{r, g, b}, 20 * r + 70 * g + 10 * b, 0});
    }
  }
  const auto line = *FitLineThroughOrigin(readings, "t");
  EXPECT_NEAR(line.slopes[0], 20, 1e-12);
  EXPECT_NEAR(line.slopes[2], 10, 1e-12);
  EXPECT_LT(line.worst_of_maximum, 1e-14);
}

TEST(ProportionalityTest, WhatCannotBeFittedIsRefused) {
  EXPECT_FALSE(FitLineThroughOrigin({}, "t").ok());
  const std::vector<RenderedReading> one = {{{1}, 1, 0}};
  EXPECT_FALSE(FitLineThroughOrigin(one, "t").ok());
  const std::vector<RenderedReading> dark = {{{1}, 0, 0}, {{2}, 0, 0}};
  EXPECT_FALSE(FitLineThroughOrigin(dark, "t").ok());
  const std::vector<RenderedReading> grey = {
      {{1, 1, 1}, 1, 0}, {{2, 2, 2}, 2, 0}, {{3, 3, 3}, 3, 0}, {{4, 4, 4}, 4, 0}};
  EXPECT_FALSE(FitLineThroughOrigin(grey, "t").ok());
}

std::vector<JudgedReading> Readings(double error, double noise, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  std::vector<JudgedReading> readings;
  for (int i = 1; i <= 20; ++i) {
    const double x = i / 20.0;
    const double truth = 300 * x * (1 + (i % 2 == 0 ? error : -error));
    readings.push_back({x, truth * (1 + noise * normal(random)), truth * noise, 0.008});
  }
  return readings;
}

TEST(ProportionalityTest, TableAtTheEdgeOfItsCertificateSeldomFails) {
  std::mt19937_64 random(5);
  int failed = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    if (!JudgeProportional(Readings(0.008, 0.003, random), 20).passes) ++failed;
  }
  EXPECT_LE(failed, 20);
}

TEST(ProportionalityTest, TableBeyondItsCertificateFails) {
  std::mt19937_64 random(6);
  int passed = 0;
  for (int trial = 0; trial < 200; ++trial) {
    if (JudgeProportional(Readings(0.02, 0.003, random), 20).passes) ++passed;
  }
  EXPECT_LE(passed, 10);
  const auto judgement = JudgeProportional(Readings(0.02, 0, random), 20);
  EXPECT_FALSE(judgement.passes);
  EXPECT_NEAR(judgement.proportionality_error, 0.02, 1e-12);
}

TEST(PlacesTest, MeanAndItsSigmaLeaveThePixelsOwnGainsAside) {
  std::mt19937_64 random(8);
  std::normal_distribution<double> normal;
  const PlaceGrid grid{{33, 20}, 16};
  EXPECT_EQ(grid.size(), (ImageSize{3, 2}));
  EXPECT_EQ(grid.PixelsOf(5).size(), 4u) << "the corner: 1 x 4";
  constexpr size_t kLevels = 8;
  std::vector<float> luminance(kLevels * 33 * 20);
  for (size_t pixel = 0; pixel < 660; ++pixel) {
    const double gain = 1 + 0.1 * normal(random);
    for (size_t level = 0; level < kLevels; ++level) {
      luminance[level * 660 + pixel] =
          static_cast<float>(10.0 * (1 + static_cast<double>(level)) * gain + 0.5 * normal(random));
    }
  }
  const std::vector<uint8_t> valid(660, 1);
  const PlaceSeries series = AverageOverPlace(grid, 0, kLevels, luminance, valid);
  ASSERT_EQ(series.mean.size(), kLevels);
  EXPECT_NEAR(series.mean[7], 80, 3);
  for (size_t level = 0; level < 4; ++level) EXPECT_NEAR(series.sigma[level], 0.5 / 16, 0.005);
  const std::vector<uint8_t> none(660, 0);
  EXPECT_TRUE(AverageOverPlace(grid, 0, kLevels, luminance, none).mean.empty());
}

}  // namespace
}  // namespace eyebox::fit
