#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "optics/photometry/colour_matrix.h"
#include "optics/photometry/fit_luminance_scale.h"
#include "optics/photometry/monotone_curve.h"
#include "optics/photometry/photodiode_scale.h"

namespace eyebox::optics {
namespace {

using testing::Contains;
using testing::HasSubstr;

constexpr double kScale = 3.7e-4;  // cd/m2 per DN/s

// Eight luminances over two decades, each 0.3 % in the meter and 0.2 % + 20 DN/s in the camera.
std::vector<ScaleReading> Readings(unsigned seed, double intercept_dn_s, double meter_factor = 1,
                                   double unit = 1) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> noise(0, 1);
  std::vector<ScaleReading> readings;
  for (const double luminance : {1.0, 2.0, 5.0, 10.0, 20.0, 40.0, 70.0, 100.0}) {
    const double truth = unit * luminance;
    const double rate = truth / kScale + unit * intercept_dn_s;
    const double rate_sigma = 0.002 * rate + 20 * unit;
    const double luminance_sigma = 0.003 * truth;
    const double meter = noise(random);
    const double camera = noise(random);
    readings.push_back({.luminance_cd_m2 = meter_factor * truth + luminance_sigma * meter,
                        .luminance_sigma = luminance_sigma,
                        .reading = rate + rate_sigma * camera,
                        .reading_sigma = rate_sigma});
  }
  return readings;
}

TEST(LuminanceScale, StatedIntervalCoversTheTruth) {
  constexpr double kMeter = 0.02;
  int covered = 0;
  int intercepts = 0;
  constexpr int kSeeds = 400;
  std::mt19937_64 random(99);
  std::normal_distribution<double> noise(0, 1);
  for (unsigned seed = 1; seed <= kSeeds; ++seed) {
    const auto readings = Readings(seed, 0, 1 + kMeter * noise(random));
    const auto fit = FitLuminanceScale(readings, {.meter_relative_sigma = kMeter});
    ASSERT_TRUE(fit.ok()) << fit.status();
    const double off = fit->per_unit.luminance_cd_m2 / kScale - 1;
    covered += std::abs(off) < 1.96 * fit->per_unit.relative_sigma ? 1 : 0;
    intercepts += fit->accepted ? 0 : 1;
  }
  EXPECT_NEAR(covered, 0.95 * kSeeds, 0.022 * kSeeds);  // 2 sigma of 400 trials
  EXPECT_LE(intercepts, 0.02 * kSeeds);                 // 1 % is meant
}

TEST(LuminanceScale, FitsBetterThanTheMeter) {
  const auto fit = FitLuminanceScale(Readings(1, 0), {.meter_relative_sigma = 0});
  ASSERT_TRUE(fit.ok());
  EXPECT_LT(fit->fit_relative_sigma, 0.002);
  EXPECT_THAT(fit->warnings, Contains(HasSubstr("meter's calibration uncertainty was not given")));
}

TEST(LuminanceScale, AnInterceptIsFoundAndNotAccepted) {
  const auto fit = FitLuminanceScale(Readings(1, 200));
  ASSERT_TRUE(fit.ok());
  EXPECT_FALSE(fit->accepted);
  EXPECT_LT(fit->intercept_p_value, 1e-3);
  EXPECT_NEAR(fit->intercept_cd_m2, -200 * kScale, 3 * fit->intercept_sigma_cd_m2);
  EXPECT_THAT(fit->reasons, Contains(HasSubstr("does not go through the origin")));
}

TEST(LuminanceScale, MoreScatterThanStatedWidensIt) {
  auto readings = Readings(1, 0);
  const double before = FitLuminanceScale(readings)->fit_relative_sigma;
  for (size_t i = 0; i < readings.size(); ++i) readings[i].reading *= i % 2 == 0 ? 1.03 : 0.97;
  const auto fit = FitLuminanceScale(readings);
  ASSERT_TRUE(fit.ok());
  EXPECT_GT(fit->fit_relative_sigma, 3 * before);
  EXPECT_THAT(fit->warnings, Contains(HasSubstr("times as much as their sigmas say")));
}

TEST(LuminanceScale, HoldsFromStarlightToSnow) {
  for (const double unit : {1e-6, 1e-4, 1.0, 1e3}) {
    const auto fit = FitLuminanceScale(Readings(5, 0, 1, unit));
    ASSERT_TRUE(fit.ok()) << fit.status();
    EXPECT_NEAR(fit->per_unit.luminance_cd_m2 / kScale, 1, 3 * fit->fit_relative_sigma);
    EXPECT_TRUE(fit->accepted);
  }
}

TEST(LuminanceScale, SaysWhatIsWrong) {
  auto readings = Readings(1, 0);
  EXPECT_THAT(FitLuminanceScale(std::span(readings).first(2)).status().message(),
              HasSubstr("at least 3 known luminances"));
  readings[3].luminance_sigma = readings[3].reading_sigma = 0;
  EXPECT_THAT(FitLuminanceScale(readings).status().message(), HasSubstr("reading 4: has no unc"));
  for (ScaleReading& reading : readings) reading = {5, 0.1, 100, 1};
  EXPECT_THAT(FitLuminanceScale(readings).status().message(),
              HasSubstr("all readings are of one luminance"));
}

TEST(MonotoneCurve, RisesThroughItsKnotsAndInvertsExactly) {
  const auto curve = MonotoneCurve::Through({0, 1, 1.1, 5, 6, 20}, {-3, -2.9, 4, 4.001, 50, 51});
  ASSERT_TRUE(curve.ok());
  EXPECT_EQ(curve->At(1.1), 4);
  EXPECT_EQ(curve->At(20), 51);
  double last = -4;
  for (int i = 0; i <= 4000; ++i) {
    const double x = 20 * i / 4000.0;
    const double y = *curve->At(x);
    EXPECT_GT(y, last);
    EXPECT_NEAR(*curve->At(*curve->InverseAt(y)), y, 54e-13);
    last = y;
  }
  EXPECT_FALSE(curve->At(-1e-9).has_value());
  EXPECT_FALSE(curve->At(20.1).has_value());
  EXPECT_FALSE(curve->InverseAt(52).has_value());
  EXPECT_FALSE(curve->At(NAN).has_value());
  // Continuous slope at a knot.
  EXPECT_NEAR(*curve->SlopeAt(5 - 1e-9), *curve->SlopeAt(5 + 1e-9), 1e-5);
  EXPECT_FALSE(MonotoneCurve::Through({0, 1, 1}, {0, 1, 2}).ok());
}

TEST(MonotoneCurve, IsotonicPoolsWhatFalls) {
  const std::vector<double> value = {1, 3, 2, 4};
  EXPECT_EQ(Isotonic(value, std::vector<double>{1, 1, 1, 1}),
            (std::vector<double>{1, 2.5, 2.5, 4}));
  EXPECT_EQ(Isotonic(value, std::vector<double>{1, 3, 1, 1}),
            (std::vector<double>{1, 2.75, 2.75, 4}));
}

// Three a decade, 0.5 % noise.
std::vector<ScaleReading> Photodiode(double (*counts_of)(double), double from, double to,
                                     unsigned seed, double relative = 0.005) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> noise(0, 1);
  std::vector<ScaleReading> readings;
  for (double luminance = from; luminance <= 1.0001 * to; luminance *= std::pow(10, 1 / 3.0)) {
    const double counts = counts_of(luminance);
    readings.push_back({.luminance_cd_m2 = luminance,
                        .reading = counts * (1 + relative * noise(random)),
                        .reading_sigma = std::abs(relative * counts)});
  }
  return readings;
}

TEST(PhotodiodeScale, FollowsTheResponseOverNineDecades) {
  const auto power = [](double luminance) { return 1e5 * std::pow(luminance, 0.9) + 3; };
  const auto fit = FitPhotodiode(Photodiode(power, 1e-4, 1e5, 1), 0.02);
  ASSERT_TRUE(fit.ok()) << fit.status();
  EXPECT_EQ(fit->scale.Axes(), PhotodiodeAxes::kLogLog);
  EXPECT_LT(fit->leave_one_out_rms_relative, 0.02);
  EXPECT_GT(fit->relative_sigma, 0.02);
  for (double luminance = 2e-4; luminance < 9e4; luminance *= 1.7) {
    EXPECT_NEAR(*fit->scale.LuminanceOf(power(luminance)) / luminance, 1, 0.03);
    EXPECT_NEAR(*fit->scale.LuminanceOf(*fit->scale.CountsOf(luminance)) / luminance, 1, 1e-12);
  }
}

TEST(PhotodiodeScale, TakesALogarithmicAmplifierAndAnInvertingOne) {
  const auto logarithmic = [](double luminance) { return 2000 + 300 * std::log(luminance); };
  const auto fit = FitPhotodiode(Photodiode(logarithmic, 0.1, 1000, 1, 1e-4), 0);
  ASSERT_TRUE(fit.ok()) << fit.status();
  EXPECT_EQ(fit->scale.Axes(), PhotodiodeAxes::kLinearLog);
  const auto inverting = [](double luminance) { return 4000 - 3 * luminance; };
  const auto inverse = FitPhotodiode(Photodiode(inverting, 10, 1000, 1, 1e-5), 0);
  ASSERT_TRUE(inverse.ok()) << inverse.status();
  EXPECT_EQ(inverse->scale.Axes(), PhotodiodeAxes::kLinear);
  EXPECT_NEAR(*inverse->scale.LuminanceOf(4000 - 3 * 123), 123, 0.5);
}

TEST(PhotodiodeScale, PoolsWhatNoisePutOutOfOrderAndRefusesWhatLiesOutside) {
  const auto linear = [](double luminance) { return 100 * luminance; };
  auto readings = Photodiode(linear, 1, 100, 1, 1e-4);
  std::swap(readings[2].reading, readings[3].reading);
  const auto fit = FitPhotodiode(readings, 0);
  ASSERT_TRUE(fit.ok()) << fit.status();
  EXPECT_EQ(fit->pooled, 1);
  EXPECT_THAT(fit->warnings, Contains(HasSubstr("1 of 7 readings were out of order")));
  const auto outside = fit->scale.LuminanceOf(1e6);
  EXPECT_EQ(outside.status().code(), absl::StatusCode::kOutOfRange);
  EXPECT_THAT(outside.status().message(), HasSubstr("outside the calibrated"));
  EXPECT_FALSE(fit->scale.CountsOf(1e6).ok());
}

constexpr double kTruth[3][3] = {{0.5, 0.3, 0.15}, {0.25, 0.65, 0.06}, {0.02, 0.1, 0.9}};

std::vector<ColourSample> Colours(unsigned seed, double sigma, double constant) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> noise(0, 1);
  std::vector<ColourSample> samples;
  for (int code = 1; code < 27; ++code) {
    ColourSample sample;
    sample.signal = {code % 3 * 40.0 + 1, code / 3 % 3 * 50.0 + 2, code / 9 * 45.0 + 1};
    for (int row = 0; row < 3; ++row) {
      sample.xyz[row] = constant;
      for (int k = 0; k < 3; ++k) sample.xyz[row] += kTruth[row][k] * sample.signal[k];
      sample.xyz[row] += sigma * noise(random);
      sample.xyz_sigma[row] = sigma;
    }
    samples.push_back(sample);
  }
  return samples;
}

TEST(ColourMatrix, RecoversTheMatrixWithinItsUncertainty) {
  for (const double constant : {0.0, 2.0}) {
    double squared_pulls = 0;
    int with_constant = 0;
    for (unsigned seed = 1; seed <= 100; ++seed) {
      const auto fit = FitColourMatrix(Colours(seed, 0.2, constant));
      ASSERT_TRUE(fit.ok()) << fit.status();
      with_constant += fit->columns == 4 ? 1 : 0;
      const int n = fit->columns;
      const double sigma = std::sqrt(fit->covariance[0]);
      squared_pulls += std::pow((fit->matrix[0] - kTruth[0][0]) / sigma, 2);
      EXPECT_NEAR(fit->matrix[n + 1], kTruth[1][1], 5 * std::sqrt(fit->covariance[n * n + n + 1]));
    }
    EXPECT_NEAR(squared_pulls / 100, 1, 0.45);  // 3 sigma of 100 squared pulls
    if (constant > 0) {
      EXPECT_EQ(with_constant, 100);
    } else {
      EXPECT_LT(with_constant, 40);
    }
  }
}

TEST(ColourMatrix, LeaveOneOutIsARefitWithoutTheSample) {
  const auto all = Colours(3, 0.5, 0);
  double sum = 0;
  double largest = 0;
  for (size_t i = 0; i < all.size(); ++i) {
    auto others = all;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
    const auto fit = FitColourMatrix(others);
    ASSERT_TRUE(fit.ok());
    ASSERT_EQ(fit->columns, 3);
    const auto xyz = fit->Xyz(all[i].signal);
    for (int k = 0; k < 3; ++k) sum += std::pow(xyz[k] - all[i].xyz[k], 2);
    largest = std::max(largest, all[i].xyz[1]);
  }
  const auto fit = FitColourMatrix(all);
  EXPECT_NEAR(fit->leave_one_out_rms_3,
              std::sqrt(sum / (3.0 * static_cast<double>(all.size()))) / largest, 1e-12);
}

TEST(ColourMatrix, LightsThatDoNotTellTheSignalsApartAreRefused) {
  auto samples = Colours(1, 0.2, 0);
  for (ColourSample& sample : samples) sample.signal[2] = 2 * sample.signal[1];
  const auto fit = FitColourMatrix(samples);
  EXPECT_EQ(fit.status().code(), absl::StatusCode::kFailedPrecondition);
  EXPECT_THAT(FitColourMatrix(std::span(samples).first(3)).status().message(),
              HasSubstr("at least 4 lights"));
}

}  // namespace
}  // namespace eyebox::optics
