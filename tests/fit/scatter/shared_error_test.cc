// An error that readings share, such as the flat's in the middle of all images, does not average
// away over them.
#include <gtest/gtest.h>

#include <cmath>

#include "absl/status/status.h"
#include "fit/scatter/glare_model.h"
#include "tests/fit/scatter/simulated_glare.h"

namespace eyebox::fit {
namespace {

constexpr double kSharedRelative = 0.02;
constexpr int kSeries = 40;
const optics::ScatterKernel kLens{
    .core_radius_deg = 0.06, .tail_share = 0.1, .tail_radius_deg = 0.7, .tail_exponent = 2.8};
const GlareScene kScene{.relative_sigma = 0.0005};

// What looks at the axis reads too much or too little, always by the same share; what looks beside
// it is known much better, since it is the mean of many pixels.
GlareSeries WithSharedError(uint64_t seed, double stated) {
  GlareSeries series = SimulateGlare(kLens, {.relative_sigma = 0.01}, seed);
  const GlareSeries beside = SimulateGlare(kLens, kScene, seed + 1000);
  RandomStream random({seed, 8});
  const double error = kSharedRelative * Gaussian(random);
  for (size_t i = 0; i < series.readings.size(); ++i) {
    GlareReading& reading = series.readings[i];
    if (reading.offset_deg > 0) {
      reading = beside.readings[i];
      continue;
    }
    reading.luminance *= 1 + error;
    reading.shared_sigma = stated * reading.luminance;
  }
  return series;
}

double RmsPullOfTailShare(double stated) {
  ScatterFitOptions options;  // so that what lies beside the axis tells the share of the tail well
  options.tail_radius_deg = kLens.tail_radius_deg;
  options.tail_exponent = kLens.tail_exponent;
  double squares = 0;
  for (uint64_t seed = 1; seed <= kSeries; ++seed) {
    const auto fit = FitScatter(WithSharedError(seed, stated), options);
    if (!fit.ok()) return NAN;
    const Parameter& share = fit->parameters[kTailShare];
    squares += std::pow((share.value - kLens.tail_share) / share.sigma, 2);
  }
  return std::sqrt(squares / kSeries);
}

TEST(SharedError, EntersTheCovarianceOnceForAllReadings) {
  EXPECT_NEAR(RmsPullOfTailShare(kSharedRelative), 1, 4 / std::sqrt(2.0 * kSeries));
  EXPECT_GT(RmsPullOfTailShare(0), 2) << "else nothing is shown here";
}

TEST(SharedError, ThatAllReadingsHaveChangesTheScaleAlone) {
  GlareSeries series = SimulateGlare(kLens, kScene, 3);
  const auto without = FitScatter(series);
  for (GlareReading& reading : series.readings) reading.shared_sigma = 0.02 * reading.luminance;
  const auto with = FitScatter(series);
  ASSERT_TRUE(without.ok() && with.ok());
  EXPECT_NEAR(with->parameters[kTailShare].sigma / without->parameters[kTailShare].sigma, 1, 1e-3);
  EXPECT_NEAR(with->parameters[kBright].sigma / with->bright_luminance, 0.02, 1e-3);
}

TEST(SharedError, BelowZeroIsRefused) {
  GlareSeries series = SimulateGlare(kLens, kScene, 3);
  series.readings[4].shared_sigma = -1;
  const absl::Status status = FitScatter(series).status();
  EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
  EXPECT_NE(status.message().find("glare reading 5"), std::string::npos) << status;
}

}  // namespace
}  // namespace eyebox::fit
