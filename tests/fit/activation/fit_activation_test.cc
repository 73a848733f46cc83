#include "fit/activation/fit_activation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "fit/activation/activation_problem.h"
#include "tests/fit/activation/simulated_series.h"

namespace eyebox::fit {
namespace {

using ::testing::HasSubstr;
constexpr ActivationModel kCutoff = ActivationModel::kGammaWithCutoff;
constexpr ActivationModel kOffset = ActivationModel::kPowerOffset;

std::array<double, 4> Values(const Activation& a) {
  return {a.minimum_luminance, a.luminance_range, a.cutoff_drive, a.gamma};
}

TEST(FitActivationTest, NoiselessTruthIsRecovered) {
  for (const double gamma : {0.5, 1.0, 1.8, 2.2, 2.6, 5.0}) {
    for (const double cutoff : {0.0, 0.0335, 0.2}) {
      const Activation truth{0.8, 420, cutoff, gamma};
      for (const Weighting weighting : {Weighting::kRelative, Weighting::kUnweighted}) {
        const auto fit = FitActivation(SimulateSeries(truth, 17, 0), kCutoff, weighting);
        ASSERT_TRUE(fit.ok()) << fit.status();
        for (int i = 0; i < 4; ++i) {
          EXPECT_NEAR(Values(fit->activation)[i], Values(truth)[i], 1e-6 * (1 + Values(truth)[i]))
              << "gamma " << gamma << ", v0 " << cutoff << ", " << fit->parameters[i].name;
        }
        EXPECT_LT(fit->leave_one_out_rms_relative, 1e-3);
        EXPECT_EQ(fit->degrees_of_freedom, 13);
      }
    }
  }
}

TEST(FitActivationTest, LuminanceOfAnyUnitIsFittedAlike) {
  std::vector<double> gammas;
  for (const double scale : {1e-6, 1.0, 1e6}) {
    const Activation truth{0.002 * scale, scale, 0.04, 2.4};
    LevelSeries series = SimulateSeries(truth, 11, 0.01, 7);
    const auto fit = FitActivation(series, kCutoff, Weighting::kMeasuredSigma);
    ASSERT_TRUE(fit.ok()) << fit.status();
    gammas.push_back(fit->activation.gamma);
    EXPECT_NEAR(gammas.back(), gammas.front(), 1e-7);
  }
}

// Sigmas against the scatter of refits: absolute, from the stated sigmas.
TEST(FitActivationTest, CovarianceIsThatOfRepeatedSeries) {
  const Activation truth{1, 400, 0.05, 2.2};
  const auto fit =
      FitActivation(SimulateSeries(truth, 17, 0.01), kCutoff, Weighting::kMeasuredSigma);
  ASSERT_TRUE(fit.ok()) << fit.status();
  const double scale = std::max(fit->chi_square / fit->degrees_of_freedom, 1.0);
  constexpr int kSeries = 200;
  std::array<double, 4> squares{};
  for (uint64_t seed = 0; seed < kSeries; ++seed) {
    ActivationProblem problem{kCutoff, {}};
    for (const LevelReading& r : SimulateSeries(truth, 17, 0.01, 100 + seed).readings) {
      problem.readings.push_back({r.drive, r.luminance, 1 / r.luminance_sigma});
    }
    const auto refit = SolveActivation(problem, StartingPoints(problem));
    ASSERT_TRUE(refit.ok()) << refit.status();
    for (int i = 0; i < 4; ++i) {
      squares[i] += std::pow(Values(refit->activation)[i] - Values(truth)[i], 2) / kSeries;
    }
  }
  for (int i = 0; i < 4; ++i) {
    const double sigma = fit->parameters[i].sigma / std::sqrt(scale);
    EXPECT_NEAR(std::sqrt(squares[i]) / sigma, 1, 0.15) << fit->parameters[i].name;
    EXPECT_NEAR(fit->covariance[5 * i], fit->parameters[i].sigma * fit->parameters[i].sigma,
                1e-12 * fit->covariance[5 * i]);
  }
}

TEST(FitActivationTest, ParameterAtItsBoundKeepsASigma) {
  // A bulge that only a cutoff below 0 would follow.
  LevelSeries series = SimulateSeries({1, 100, 0, 2.2}, 11, 0);
  for (LevelReading& r : series.readings) r.luminance += 3 * r.drive * (1 - r.drive);
  const auto fit = FitActivation(series, kCutoff, Weighting::kRelative);
  ASSERT_TRUE(fit.ok()) << fit.status();
  EXPECT_EQ(fit->activation.cutoff_drive, 0);
  EXPECT_THAT(fit->termination, HasSubstr("at a bound: cutoff_drive"));
  EXPECT_GT(fit->parameters[2].sigma, 0);
  EXPECT_LT(fit->parameters[2].sigma, 0.1);
}

TEST(FitActivationTest, HeldCutoffHasNoSigma) {
  const auto fit =
      FitActivation(SimulateSeries({1, 100, 0, 2.2}, 11, 0.01), kOffset, Weighting::kRelative);
  ASSERT_TRUE(fit.ok()) << fit.status();
  EXPECT_EQ(fit->parameters[2].value, 0);
  EXPECT_EQ(fit->parameters[2].sigma, 0);
  EXPECT_EQ(fit->degrees_of_freedom, 8);
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(fit->covariance[8 + i], 0);
    EXPECT_EQ(fit->covariance[4 * i + 2], 0);
  }
}

TEST(FitActivationTest, ScaleUncertaintyGoesToTheLuminancesOnly) {
  LevelSeries series = SimulateSeries({1, 100, 0.05, 2.2}, 17, 0.001);
  const auto without = FitActivation(series, kCutoff, Weighting::kMeasuredSigma);
  series.scale_relative_sigma = 0.04;
  const auto with = FitActivation(series, kCutoff, Weighting::kMeasuredSigma);
  ASSERT_TRUE(without.ok() && with.ok());
  EXPECT_NEAR(with->parameters[1].sigma, 4, 0.05);
  EXPECT_EQ(with->parameters[3].sigma, without->parameters[3].sigma);
}

TEST(FitActivationTest, RepeatedReadingsOfOneDriveAreFitted) {
  const Activation truth{1, 100, 0.05, 2.2};
  LevelSeries series = SimulateSeries(truth, 11, 0.01, 1);
  for (uint64_t seed = 2; seed <= 4; ++seed) {
    const LevelSeries again = SimulateSeries(truth, 11, 0.01, seed);
    series.readings.insert(series.readings.end(), again.readings.begin(), again.readings.end());
  }
  std::stable_sort(series.readings.begin(), series.readings.end(),
                   [](const auto& a, const auto& b) { return a.drive < b.drive; });
  const auto fit = FitActivation(series, kCutoff, Weighting::kMeasuredSigma);
  ASSERT_TRUE(fit.ok()) << fit.status();
  EXPECT_EQ(fit->degrees_of_freedom, 40);
  EXPECT_NEAR(fit->activation.gamma, 2.2, 3 * fit->parameters[3].sigma);
  EXPECT_NEAR(fit->leave_one_out_rms_relative, 0.01, 0.004);
}

TEST(FitActivationTest, TrueBlackDoesNotDivideByZero) {
  const auto fit =
      FitActivation(SimulateSeries({0, 100, 0.1, 2.2}, 17, 0), kCutoff, Weighting::kRelative);
  ASSERT_TRUE(fit.ok()) << fit.status();
  EXPECT_NEAR(fit->activation.gamma, 2.2, 1e-6);
  EXPECT_TRUE(std::isfinite(fit->rms_relative));
  EXPECT_TRUE(std::isfinite(fit->leave_one_out_rms_relative));
  for (const FittedLevel& level : fit->levels) {
    EXPECT_TRUE(std::isfinite(level.relative_residual));
  }
}

TEST(FitActivationTest, MeasuredSigmasMustBeThere) {
  LevelSeries series = SimulateSeries({1, 100, 0.05, 2.2}, 11, 0.01);
  series.readings[4].luminance_sigma = 0;
  const auto fit = FitActivation(series, kCutoff, Weighting::kMeasuredSigma);
  EXPECT_EQ(fit.status().code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(std::string(fit.status().message()), HasSubstr("simulated, reading 5"));
}

TEST(FitActivationTest, TooFewLevelsForTheModelAreRejected) {
  const LevelSeries series = SimulateSeries({1, 100, 0, 2.2}, 4, 0);
  EXPECT_TRUE(FitActivation(series, kOffset, Weighting::kRelative).ok());
  const auto fit = FitActivation(series, kCutoff, Weighting::kRelative);
  EXPECT_EQ(fit.status().code(), absl::StatusCode::kFailedPrecondition);
  EXPECT_THAT(std::string(fit.status().message()), HasSubstr("measure more levels"));
}

TEST(FitActivationTest, StepFunctionIsNoActivation) {
  LevelSeries series = SimulateSeries({1, 100, 0, 2.2}, 11, 0);
  for (LevelReading& r : series.readings) r.luminance = r.drive < 0.05 ? 1 : 100 + r.drive;
  const auto fit = FitActivation(series, kOffset, Weighting::kRelative);
  EXPECT_EQ(fit.status().code(), absl::StatusCode::kFailedPrecondition);
  EXPECT_THAT(std::string(fit.status().message()), HasSubstr("limit of 0.3 to 8"));
}

TEST(FitActivationTest, FlatLineIsBadInput) {
  LevelSeries series = SimulateSeries({1, 100, 0, 2.2}, 11, 0);
  for (LevelReading& r : series.readings) r.luminance = 7;
  EXPECT_EQ(FitActivation(series, kCutoff, Weighting::kRelative).status().code(),
            absl::StatusCode::kInvalidArgument);
}

}  // namespace
}  // namespace eyebox::fit
