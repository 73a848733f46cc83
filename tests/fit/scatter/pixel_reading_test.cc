#include "fit/scatter/pixel_reading.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/fit/scatter/simulated_glare.h"

namespace eyebox::fit {
namespace {

TEST(PixelReading, IsTheMeanOfItsPixelsWithTheNoiseOfIt) {
  PixelReading reading(0.1);
  EXPECT_TRUE(reading.empty());
  reading.Add(3, 0, 10, 4);
  reading.Add(0, 4, 20, 12);
  const GlareReading finished = reading.Finish(0.5);
  EXPECT_FALSE(reading.empty());
  EXPECT_NEAR(finished.luminance, 15, 1e-12);
  EXPECT_NEAR(finished.luminance_sigma, 2, 1e-12);
  double sum = 0, square = 0;
  for (const auto& [offset_deg, share] : finished.offsets) {
    sum += share;
    square += share * offset_deg * offset_deg;
  }
  EXPECT_NEAR(sum, 1, 1e-12);
  // Of the pixels' middles, and of points over a pixel's area: 1/12 px2 each way.
  EXPECT_NEAR(square, 0.25 * ((9 + 16) / 2.0 + 1 / 6.0), 1e-12);
  EXPECT_NEAR(finished.offset_deg * finished.offset_deg, square, 1e-12);
}

// A disk through a Gaussian, seen by pixels in its flank: from points laid over them by hand.
TEST(PixelReading, OffsetsStandForThePixelsArea) {
  constexpr double kPitchDeg = 0.1;
  constexpr int kPoints = 40;
  const optics::RadialWeight weight({.core_radius_deg = 0.08});
  for (const auto& [x, y] : {std::pair{2.5, 0.5}, {1.5, 2.5}, {0.5, 0.5}}) {
    PixelReading reading(0.1);
    reading.Add(x, y, 1, 1);
    double seen = 0;
    for (const auto& [offset_deg, share] : reading.Finish(kPitchDeg).offsets) {
      seen += share * optics::EnergyInDisk(weight, {0.25, offset_deg});
    }
    double truth = 0;
    for (int j = 0; j < kPoints; ++j) {
      for (int i = 0; i < kPoints; ++i) {
        const double offset_px =
            std::hypot(x + (i + 0.5) / kPoints - 0.5, y + (j + 0.5) / kPoints - 0.5);
        truth += optics::EnergyInDisk(weight, {0.25, offset_px * kPitchDeg}) / (kPoints * kPoints);
      }
    }
    EXPECT_NEAR(seen / truth, 1, 2e-3) << x << ", " << y;
  }
}

}  // namespace
}  // namespace eyebox::fit
