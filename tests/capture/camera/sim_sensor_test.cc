// The simulated sensor measured as EMVA 1288 measures a real one.
#include "capture/camera/sim/sensor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace eyebox::capture {
namespace {

constexpr uint64_t kSeed = 20;

struct Line {
  double slope = 0;
  double slope_sigma = 0;
  double intercept = 0;
  double intercept_sigma = 0;
};

// Straight line through points of known standard uncertainty.
Line FitLine(const std::vector<double>& x, const std::vector<double>& y,
             const std::vector<double>& sigma) {
  double s = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (size_t i = 0; i < x.size(); ++i) {
    const double w = 1 / (sigma[i] * sigma[i]);
    s += w, sx += w * x[i], sy += w * y[i], sxx += w * x[i] * x[i], sxy += w * x[i] * y[i];
  }
  const double determinant = s * sxx - sx * sx;
  return {.slope = (s * sxy - sx * sy) / determinant,
          .slope_sigma = std::sqrt(s / determinant),
          .intercept = (sxx * sy - sx * sxy) / determinant,
          .intercept_sigma = std::sqrt(sxx / determinant)};
}

double Mean(const std::vector<uint16_t>& counts_dn) {
  return std::accumulate(counts_dn.begin(), counts_dn.end(), 0.0) /
         static_cast<double>(counts_dn.size());
}

// Half the mean square of the difference of two frames: fixed patterns cancel.
double TemporalVariance(const std::vector<uint16_t>& a, const std::vector<uint16_t>& b) {
  double squares = 0;
  for (size_t i = 0; i < a.size(); ++i) squares += (a[i] - b[i]) * (a[i] - b[i]);
  return squares / 2 / static_cast<double>(a.size());
}

SensorParameters WithoutHotPixels() {
  SensorParameters sensor;
  sensor.hot_pixel_share = 0;
  return sensor;
}

TEST(SimSensor, PhotonTransferGivesGainAndReadNoise) {
  const SensorParameters sensor = WithoutHotPixels();
  const FixedPattern pattern = MakeFixedPattern(sensor, kSeed);
  std::vector<double> mean_dn, variance_dn2, sigma_dn2;
  for (uint64_t level = 0; level < 24; ++level) {
    const double electrons = 700.0 * static_cast<double>(level);
    const Image<double> rate(sensor.size, electrons / 0.01);
    NoiseSource noise({kSeed, level});
    const auto first = Expose(sensor, pattern, rate, {.exposure_s = 0.01}, noise);
    const auto second = Expose(sensor, pattern, rate, {.exposure_s = 0.01}, noise);
    const double variance = TemporalVariance(first, second);
    mean_dn.push_back((Mean(first) + Mean(second)) / 2 - sensor.bias_dn);
    variance_dn2.push_back(variance);
    sigma_dn2.push_back(variance * std::sqrt(2.0 / static_cast<double>(first.size())));
  }
  const Line line = FitLine(mean_dn, variance_dn2, sigma_dn2);
  EXPECT_NEAR(line.slope, sensor.gain_dn_per_e, 3.5 * line.slope_sigma);
  EXPECT_LT(line.slope_sigma, 0.005 * sensor.gain_dn_per_e);
  const double read_dn = sensor.gain_dn_per_e * sensor.read_noise_e;
  EXPECT_NEAR(line.intercept, read_dn * read_dn + 1.0 / 12, 3.5 * line.intercept_sigma);
}

TEST(SimSensor, DarkSignalGrowsWithTimeByTheDarkCurrent) {
  const SensorParameters sensor = WithoutHotPixels();
  const FixedPattern pattern = MakeFixedPattern(sensor, kSeed);
  const Image<double> no_light(sensor.size, 0.0);
  std::vector<double> time_s, mean_dn, sigma_dn;
  for (uint64_t i = 0; i < 12; ++i) {
    const double exposure_s = 0.5 + 5.0 * static_cast<double>(i);
    NoiseSource noise({kSeed, i});
    const auto frame = Expose(sensor, pattern, no_light, {.exposure_s = exposure_s}, noise);
    const double variance_e2 = sensor.dark_current_e_s * exposure_s +
                               sensor.read_noise_e * sensor.read_noise_e + 25.0 / 12;
    time_s.push_back(exposure_s);
    mean_dn.push_back(Mean(frame));
    sigma_dn.push_back(sensor.gain_dn_per_e *
                       std::sqrt(variance_e2 / static_cast<double>(frame.size())));
  }
  const Line line = FitLine(time_s, mean_dn, sigma_dn);
  const auto current_e_s = pattern.dark_current_e_s.pixels();
  const double mean_current_e_s = std::accumulate(current_e_s.begin(), current_e_s.end(), 0.0) /
                                  static_cast<double>(current_e_s.size());
  EXPECT_NEAR(mean_current_e_s, sensor.dark_current_e_s, 0.05);
  EXPECT_NEAR(line.slope, sensor.gain_dn_per_e * mean_current_e_s, 3.5 * line.slope_sigma);
  EXPECT_LT(line.slope_sigma, 0.005 * line.slope);
  const auto offset_e = pattern.offset_e.pixels();
  const double mean_offset_dn = sensor.gain_dn_per_e *
                                std::accumulate(offset_e.begin(), offset_e.end(), 0.0) /
                                static_cast<double>(offset_e.size());
  EXPECT_NEAR(line.intercept, sensor.bias_dn + mean_offset_dn, 3.5 * line.intercept_sigma);
}

TEST(SimSensor, GainInDecibelMultipliesTheSignal) {
  const SensorParameters sensor = WithoutHotPixels();
  const FixedPattern pattern = MakeFixedPattern(sensor, kSeed);
  const Image<double> rate(sensor.size, 2e5);
  NoiseSource noise({kSeed});
  const auto plain = Expose(sensor, pattern, rate, {.exposure_s = 0.01}, noise);
  const auto doubled =
      Expose(sensor, pattern, rate, {.exposure_s = 0.01, .gain_db = 6.0206}, noise);
  EXPECT_NEAR((Mean(doubled) - sensor.bias_dn) / (Mean(plain) - sensor.bias_dn), 2, 0.002);
}

TEST(SimSensor, ClipsAtFullScaleAndAtZero) {
  SensorParameters sensor;
  sensor.bias_dn = 0;
  const FixedPattern pattern = MakeFixedPattern(sensor, kSeed);
  NoiseSource noise({kSeed});
  const auto bright =
      Expose(sensor, pattern, Image<double>(sensor.size, 1e8), {.exposure_s = 0.01}, noise);
  EXPECT_TRUE(std::ranges::all_of(bright, [](uint16_t count) { return count == 4095; }));
  const auto dark =
      Expose(sensor, pattern, Image<double>(sensor.size, 0.0), {.exposure_s = 1e-5}, noise);
  EXPECT_GT(std::ranges::count(dark, 0), static_cast<std::ptrdiff_t>(dark.size() / 2));
  EXPECT_LT(*std::ranges::max_element(dark), 10);
}

TEST(SimSensor, LosesWhatExceedsTheFullWell) {
  SensorParameters sensor;
  sensor.full_well_e = 5000;
  const FixedPattern pattern = MakeFixedPattern(sensor, kSeed);
  NoiseSource noise({kSeed});
  const auto frame =
      Expose(sensor, pattern, Image<double>(sensor.size, 1e8), {.exposure_s = 0.01}, noise);
  EXPECT_NEAR(Mean(frame), sensor.bias_dn + 0.2 * 5000, 0.05);
}

TEST(SimSensor, DefaultCountsClipBeforeTheWellIsFull) {
  // Otherwise saturation would hide below full scale, where no reduction looks for it.
  for (const char* name : {"rift-s-like", "rift-s-like-cutoff", "ideal"}) {
    const auto parameters = NamedSimParameters(name);
    ASSERT_TRUE(parameters.ok());
    const SensorParameters& sensor = parameters->sensor;
    EXPECT_GT(sensor.bias_dn + sensor.gain_dn_per_e * sensor.full_well_e, (1 << sensor.bits) - 1);
  }
}

TEST(FixedPattern, HasTheStatisticsAskedFor) {
  SensorParameters sensor;
  sensor.size = {.width_px = 400, .height_px = 300};
  const FixedPattern pattern = MakeFixedPattern(sensor, kSeed);
  const double n = 120000;
  double squares = 0;
  for (const double response : pattern.response.pixels()) squares += std::pow(response - 1, 2);
  EXPECT_NEAR(std::sqrt(squares / n), 0.005, 0.005 * 4.5 / std::sqrt(2 * n));
  const auto hot = std::ranges::count_if(pattern.dark_current_e_s.pixels(),
                                         [](double current_e_s) { return current_e_s > 2000; });
  EXPECT_NEAR(static_cast<double>(hot), 0.001 * n, 4.5 * std::sqrt(0.001 * n));
  EXPECT_LT(*std::ranges::max_element(pattern.dark_current_e_s.pixels()), 20020);
}

}  // namespace
}  // namespace eyebox::capture
