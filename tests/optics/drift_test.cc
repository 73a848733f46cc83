#include "optics/photometry/drift.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "capture/base/random.h"

namespace eyebox::optics {
namespace {

using testing::HasSubstr;
using testing::SizeIs;

// Sum of 12 uniform numbers less 6: near enough to a normal one, variance 1.
double Normal(RandomStream& random) {
  double sum = -6;
  for (int i = 0; i < 12; ++i) sum += static_cast<double>(random.Below(1 << 30)) / (1 << 30);
  return sum;
}

// A reading a minute, from an hour on, of 12 cd/m2 with the given factor of x = -1 to 1.
std::vector<DriftReading> Readings(int count, double sigma, uint64_t seed,
                                   const std::function<double(double)>& factor) {
  RandomStream random({seed});
  std::vector<DriftReading> readings;
  for (int i = 0; i < count; ++i) {
    const double x = 2.0 * i / (count - 1) - 1;
    readings.push_back({3600 + 60.0 * i, 12 * (factor(x) + sigma * Normal(random)), 12 * sigma});
  }
  return readings;
}

TEST(Drift, AStraightLineIsFoundWithItsSigma) {
  const auto drift = FitDrift(Readings(7, 1e-3, 3, [](double x) { return 1 - 0.03 * x; }));
  ASSERT_TRUE(drift.ok()) << drift.status();
  EXPECT_EQ(drift->order, 1);
  EXPECT_EQ(drift->middle_s, 3780);
  EXPECT_EQ(drift->half_span_s, 180);
  const double sigma = std::sqrt(drift->linear_variance);
  EXPECT_NEAR(drift->linear, -0.03, 3 * sigma);
  // sigma / sqrt(sum x^2), x = -1, -2/3, ..., 1; the scatter may add.
  EXPECT_GE(sigma, 0.99 * 1e-3 / std::sqrt(28.0 / 9));
  EXPECT_LT(sigma, 2 * 1e-3 / std::sqrt(28.0 / 9));
  EXPECT_NEAR(drift->per_hour, drift->linear * 20, 1e-12);
  EXPECT_NEAR(drift->per_hour_sigma, sigma * 20, 1e-12);
  EXPECT_EQ(drift->FactorAt(3780), 1);
  EXPECT_NEAR(drift->FactorAt(3960), 1 + drift->linear, 1e-12);
  EXPECT_NEAR(drift->SigmaAt(3960), sigma, 1e-12);
  EXPECT_EQ(drift->SigmaAt(3780), 0);
  EXPECT_NEAR(drift->Span(), 0.06, 0.006);
}

TEST(Drift, WarmingUpBends) {
  const auto drift =
      FitDrift(Readings(9, 1e-3, 4, [](double x) { return 1 - 0.05 * x + 0.04 * x * x; }));
  ASSERT_TRUE(drift.ok()) << drift.status();
  EXPECT_EQ(drift->order, 2);
  EXPECT_NEAR(drift->quadratic, 0.04, 4 * std::sqrt(drift->quadratic_variance) + 5e-4);
  EXPECT_GT(drift->SigmaAt(drift->middle_s + drift->half_span_s), 0);
}

TEST(Drift, SeriesOfSeveralLevelsAreFittedTogether) {
  const auto factor = [](double x) { return 1 - 0.03 * x; };
  const auto all = Readings(12, 1e-3, 8, factor);
  std::vector<DriftReading> readings;
  constexpr double kLevels[] = {1, 40, 0.01};
  for (size_t i = 0; i < all.size(); ++i) {
    const int series = static_cast<int>(i % 3);
    const double level = kLevels[series];
    readings.push_back({all[i].time_s, level * all[i].value, level * all[i].sigma, series});
  }
  const auto drift = FitDrift(readings);
  ASSERT_TRUE(drift.ok()) << drift.status();
  ASSERT_EQ(drift->order, 1);
  const double sigma = std::sqrt(drift->linear_variance);
  EXPECT_NEAR(drift->linear, -0.03, 3 * sigma);
  const auto alone = *FitDrift(all);
  EXPECT_GT(sigma, std::sqrt(alone.linear_variance) / std::sqrt(std::max(alone.reduced_chi2, 1.0)));
  EXPECT_LT(sigma, 2 * std::sqrt(alone.linear_variance));
}

TEST(Drift, ASecondSeriesOfOneReadingTellsNothing) {
  const auto readings = Readings(7, 1e-3, 3, [](double x) { return 1 - 0.03 * x; });
  const auto without = *FitDrift(readings);
  auto more = readings;
  more.push_back({readings[3].time_s, 500, 1, 1});
  const auto with = *FitDrift(more);
  EXPECT_NEAR(with.linear, without.linear, 1e-12);
  EXPECT_NEAR(with.linear_variance, without.linear_variance, 1e-12);
}

TEST(Drift, NoiseIsNoDrift) {
  int found = 0;
  for (uint64_t seed = 0; seed < 2000; ++seed) {
    const auto drift = FitDrift(Readings(6, 1e-3, seed, [](double) { return 1.0; }));
    ASSERT_TRUE(drift.ok());
    if (drift->order > 0) ++found;
    if (drift->order > 0) continue;
    EXPECT_EQ(drift->FactorAt(5000), 1);
    EXPECT_EQ(drift->SigmaAt(5000), 0);
  }
  EXPECT_LT(found, 2 * 2000 * 0.0027 + 8);  // two tests of 0.27 % each
}

TEST(Drift, SigmaIsThatOfRepeatedRuns) {
  double squares = 0;
  double variance = 0;
  constexpr int kRuns = 400;
  for (uint64_t seed = 0; seed < kRuns; ++seed) {
    const auto drift = *FitDrift(Readings(8, 1e-3, seed, [](double x) { return 1 + 0.05 * x; }));
    ASSERT_GE(drift.order, 1);
    const double error = drift.FactorAt(3600 + 7 * 60) - 1.05;
    squares += error * error;
    variance += std::pow(drift.SigmaAt(3600 + 7 * 60), 2);
  }
  // Taking the larger of scatter and sigma overstates it a little.
  EXPECT_GT(variance / squares, 0.9);
  EXPECT_LT(variance / squares, 1.7);
}

TEST(Drift, ReadingsThatScatterBeyondTheirSigmaCountByTheirScatter) {
  auto readings = Readings(6, 0.02, 5, [](double x) { return 1 + 0.01 * x; });
  for (DriftReading& reading : readings) reading.sigma = 1e-6;
  const auto drift = FitDrift(readings);
  ASSERT_TRUE(drift.ok());
  EXPECT_EQ(drift->order, 0);
  EXPECT_GT(drift->reduced_chi2, 100);
  EXPECT_GT(drift->per_hour_sigma, 0.005 * 24) << "what stayed unseen is bounded";
}

TEST(Drift, MonotonicTimesOfYearsLoseNoDigits) {
  auto readings = Readings(5, 1e-4, 6, [](double x) { return 1 + 0.02 * x; });
  const auto near = *FitDrift(readings);
  for (DriftReading& reading : readings) reading.time_s += 1e9;
  const auto far = *FitDrift(readings);
  EXPECT_NEAR(near.linear, far.linear, 1e-9);
}

TEST(Drift, CorrectionDividesAndKeepsTheCommonSigmaApart) {
  const auto drift = *FitDrift(Readings(7, 1e-3, 3, [](double x) { return 1 - 0.03 * x; }));
  LuminanceImage image;
  image.image = MakeMeasuredImage({.width_px = 2, .height_px = 1}, "cd/m2");
  image.image.value.pixels()[0] = 10;
  image.image.variance.pixels()[0] = 4;
  image.image.mask.pixels()[1] = kNoData;
  BlankMaskedPixels(image.image);
  image.scale_relative_sigma = 0.02;
  const double factor = drift.FactorAt(3600);
  CorrectDrift(drift, 3600, image);
  EXPECT_NEAR(image.image.value.pixels()[0], 10 / factor, 1e-5);
  EXPECT_NEAR(image.image.variance.pixels()[0], 4 / (factor * factor), 1e-5);
  EXPECT_TRUE(std::isnan(image.image.value.pixels()[1]));
  EXPECT_NEAR(image.scale_relative_sigma, std::hypot(0.02, drift.SigmaAt(3600) / factor), 1e-12);
  ASSERT_THAT(image.image.history, SizeIs(1));
  EXPECT_THAT(image.image.history[0], HasSubstr("CorrectDrift(order 1"));
}

TEST(Drift, WithoutDriftNothingIsTouched) {
  LuminanceImage image;
  image.image = MakeMeasuredImage({.width_px = 1, .height_px = 1}, "cd/m2");
  image.image.value.pixels()[0] = 0.1F;
  CorrectDrift(Drift{}, 100, image);
  EXPECT_EQ(image.image.value.pixels()[0], 0.1F);
  EXPECT_THAT(image.image.history, SizeIs(0));
}

TEST(Drift, BadReadingsAreRefused) {
  const auto good = Readings(4, 1e-3, 1, [](double) { return 1.0; });
  const auto message = [](const std::vector<DriftReading>& readings) {
    const absl::Status status = FitDrift(readings).status();
    EXPECT_TRUE(absl::IsInvalidArgument(status)) << status;
    return std::string(status.message());
  };
  EXPECT_THAT(message({good[0], good[1]}), HasSubstr("2 readings"));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const DriftReading& bad :
       {DriftReading{nan, 1, 1}, DriftReading{1, nan, 1}, DriftReading{1, 1, nan},
        DriftReading{1, 0, 1}, DriftReading{1, -2, 1}, DriftReading{1, 1, 0}}) {
    EXPECT_THAT(message({good[0], good[1], bad}), HasSubstr("reading 3"));
  }
  EXPECT_THAT(message({good[0], good[0], good[0]}), HasSubstr("one time"));
  DriftReading other = good[3];
  other.series = 1;
  EXPECT_THAT(message({good[0], good[0], good[0], other, other}), HasSubstr("one time"));
}

}  // namespace
}  // namespace eyebox::optics
