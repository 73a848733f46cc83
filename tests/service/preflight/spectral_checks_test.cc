// The checks that look for a peak: Fisher's test, rolling shutter, moire.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "capture/camera/sim/noise.h"
#include "service/preflight/fisher_test.h"
#include "service/preflight/moire.h"
#include "service/preflight/rolling_shutter.h"
#include "service/preflight/smooth_field.h"
#include "service/preflight/spectrum.h"
#include "tests/service/preflight/preflight_bench.h"

namespace eyebox::service {
namespace {

using testing::HasSubstr;

constexpr ImageSize kSize = {.width_px = 64, .height_px = 48};

// For n = 2 the bound is the exact 2 (1 - share); 5 % of n = 5 powers lie above 0.6838 (Fisher
// 1929, table I).
TEST(FisherTest, GivesThePublishedProbability) {
  EXPECT_NEAR(LargestPeak(std::vector{3.0, 1.0}).false_alarm_probability, 0.5, 1e-12);
  const double share = 0.68377;
  const double rest = (1 - share) / 4;
  const SpectralPeak peak = LargestPeak(std::vector{rest, rest, share, rest, rest});
  EXPECT_EQ(peak.index, 2U);
  EXPECT_NEAR(peak.false_alarm_probability, 0.05, 1e-4);
  EXPECT_NEAR(ShareAt(0.05, 5), share, 1e-4);
}

TEST(FisherTest, OfNothingIsNoPeak) {
  EXPECT_EQ(LargestPeak({}).false_alarm_probability, 1);
  EXPECT_EQ(LargestPeak(std::vector{5.0}).false_alarm_probability, 1);
  EXPECT_EQ(LargestPeak(std::vector{0.0, 0.0, 0.0}).false_alarm_probability, 1);
  EXPECT_EQ(LargestPeak(std::vector{NAN, 1.0}).false_alarm_probability, 1);
}

std::vector<std::vector<double>> Rows(double band, uint64_t seed, size_t frames = 4) {
  capture::NoiseSource noise({seed});
  std::vector<std::vector<double>> rows(frames, std::vector<double>(96));
  for (std::vector<double>& frame : rows) {
    const double phase = noise.Uniform();
    for (size_t y = 0; y < frame.size(); ++y) {
      const double turns = static_cast<double>(y) / 24 + phase;
      const double scene = 500 - 0.05 * std::pow(static_cast<double>(y) - 48, 2);
      frame[y] =
          scene * (1 + band * std::sin(2 * std::numbers::pi * turns)) + 0.5 * noise.Gaussian();
    }
  }
  return rows;
}

TEST(RollingShutter, ShowsBandsOfTheRightPeriodAndHeight) {
  const Check check = CheckRollingShutter(Rows(0.01, 1));
  EXPECT_EQ(check.verdict, Verdict::kFailed);
  EXPECT_NEAR(FigureOf(check, "band_period"), 24, 1e-9);
  // Dividing by the mean of four frames takes part of the band along.
  EXPECT_NEAR(FigureOf(check, "band_amplitude"), 0.01, 0.008);
}

TEST(RollingShutter, AlarmsOnNoiseAsOftenAsItSays) {
  int alarms = 0;
  for (uint64_t seed = 0; seed < 400; ++seed) {
    const Check check = CheckRollingShutter(Rows(0, seed), {.false_alarm_probability = 0.05});
    if (check.verdict == Verdict::kFailed) ++alarms;
  }
  EXPECT_LE(alarms, 20 + 3 * 5) << "of 400 at 5 %";
  EXPECT_GE(alarms, 5) << "the test is alive";
}

TEST(RollingShutter, WithoutLightOrWithOneFrameIsSkipped) {
  EXPECT_EQ(CheckRollingShutter({}).verdict, Verdict::kSkipped);
  EXPECT_EQ(CheckRollingShutter(Rows(0.1, 1, 1)).verdict, Verdict::kSkipped);
  const std::vector<std::vector<double>> dark(4, std::vector<double>(96, 0.0));
  EXPECT_EQ(CheckRollingShutter(dark).verdict, Verdict::kSkipped);
  const std::vector<std::vector<double>> ragged = {std::vector<double>(96, 1.0), {1.0}};
  EXPECT_EQ(CheckRollingShutter(ragged).verdict, Verdict::kSkipped);
  const std::vector<std::vector<double>> saturated(4, std::vector<double>(96, 4095.0));
  EXPECT_EQ(CheckRollingShutter(saturated).verdict, Verdict::kPassed) << "no bands are seen";
}

Image<double> Field(double wave, uint64_t seed) {
  capture::NoiseSource noise({seed});
  Image<double> field(kSize);
  for (int y = 0; y < kSize.height_px; ++y) {
    for (int x = 0; x < kSize.width_px; ++x) {
      const double s = (x - 30.0) / 32;
      const double t = (y - 25.0) / 32;
      field.at(x, y) = 1000 * std::exp(-0.2 * (s * s + t * t)) * (1 + 0.02 * s) *
                           (1 + wave * std::cos(2 * std::numbers::pi * (x / 4.0 + y / 6.0))) +
                       5 * noise.Gaussian();
    }
  }
  return field;
}

TEST(Spectrum, OfAWaveIsItsAmplitudeSquared) {
  Image<double> image(kSize);
  for (int y = 0; y < kSize.height_px; ++y) {
    for (int x = 0; x < kSize.width_px; ++x) {
      image.at(x, y) = 0.3 * std::cos(2 * std::numbers::pi * (8 * x / 64.0 - 6 * y / 48.0));
    }
  }
  const Image<double> power = PowerSpectrum(image);
  EXPECT_NEAR(power.at(8, 42), 0.09, 1e-12) << "row 42 is -6";
  EXPECT_NEAR(power.at(8, 6), 0, 1e-12);
}

TEST(SmoothFieldTest, LeavesTextureAndTakesShape) {
  const Image<double> texture = RelativeTexture(Field(0, 1));
  double sum = 0;
  for (const double value : texture.pixels()) sum += value * value;
  EXPECT_NEAR(std::sqrt(sum / 3072), 0.0053, 0.0005) << "noise 5 of about 950";
  EXPECT_TRUE(RelativeTexture(Image<double>({.width_px = 15, .height_px = 99}, 1.0)).empty());
  EXPECT_TRUE(RelativeTexture(Image<double>(kSize, 0.0)).empty());
}

TEST(Moire, IsFoundWithPeriodAndAmplitude) {
  const Check check = CheckMoire(Field(0.01, 1), {.camera_px_per_display_px = 0.8});
  EXPECT_EQ(check.verdict, Verdict::kFailed);
  EXPECT_NEAR(FigureOf(check, "moire_period"), 1 / std::hypot(1 / 4.0, 1 / 6.0), 1e-9);
  EXPECT_NEAR(FigureOf(check, "moire_amplitude"), 0.01, 0.001);
  EXPECT_NEAR(FigureOf(check, "expected_period"), 4, 1e-9) << "1 / 0.8 - 1 is a quarter";
  EXPECT_THAT(check.cause, HasSubstr("0.8 camera pixels per display pixel"));
}

TEST(Moire, AlarmsOnNoiseAsOftenAsItSays) {
  int alarms = 0;
  for (uint64_t seed = 0; seed < 200; ++seed) {
    const Check check = CheckMoire(Field(0, seed), {.false_alarm_probability = 0.05});
    if (check.verdict == Verdict::kFailed) ++alarms;
  }
  EXPECT_LE(alarms, 10 + 3 * 4) << "of 200 at 5 %";
  EXPECT_GE(alarms, 1) << "the test is alive";
}

TEST(Moire, IsNotMistakenForColumnsThatDiffer) {
  Image<double> field = Field(0, 3);
  capture::NoiseSource noise({9});
  for (int x = 0; x < kSize.width_px; ++x) {
    const double gain = 1 + 0.01 * noise.Gaussian();
    for (int y = 0; y < kSize.height_px; ++y) field.at(x, y) *= gain;
  }
  EXPECT_EQ(CheckMoire(field).verdict, Verdict::kPassed);
}

TEST(Moire, OfExtremesIsSkippedOrNone) {
  EXPECT_EQ(CheckMoire({}).verdict, Verdict::kSkipped);
  EXPECT_EQ(CheckMoire(Image<double>(kSize, 0.0)).verdict, Verdict::kSkipped);
  EXPECT_EQ(CheckMoire(Image<double>(kSize, NAN)).verdict, Verdict::kSkipped);
  EXPECT_NE(CheckMoire(Image<double>(kSize, 4095.0)).verdict, Verdict::kFailed) << "saturated";
}

}  // namespace
}  // namespace eyebox::service
