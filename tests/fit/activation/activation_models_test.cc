// The sRGB-like and the spline model, and what every model's covariance promises.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "fit/activation/activation_problem.h"
#include "tests/fit/activation/simulated_series.h"

namespace eyebox::fit {
namespace {

using ::testing::HasSubstr;

Activation Bent() {
  const std::vector<double> places = {0, 0.5, 1};
  const std::vector<double> log_slopes = {0.06, -0.1, 0};
  return {1, 400, 0.04, 2.2, 0, MonotoneWarp::FromLogSlopes(places, log_slopes)};
}

TEST(ActivationModelsTest, SrgbIsRecoveredAndChosen) {
  const Activation truth{0.5, 200, 0, 2.4, 0.0393};
  const auto choice = ChooseActivation(SimulateSeries(truth, 17, 0));
  ASSERT_TRUE(choice.ok()) << choice.status();
  EXPECT_EQ(choice->best.model, ActivationModel::kSrgbLike);
  EXPECT_NEAR(choice->best.activation.gamma, 2.4, 1e-6);
  EXPECT_NEAR(choice->best.activation.toe_drive, 0.0393, 1e-6);
  EXPECT_EQ(choice->best.parameters.size(), 5U);
}

TEST(ActivationModelsTest, SplineIsChosenWhereNoGammaFollows) {
  const auto choice = ChooseActivation(SimulateSeries(Bent(), 17, 0.002));
  ASSERT_TRUE(choice.ok()) << choice.status();
  EXPECT_EQ(choice->best.model, ActivationModel::kMonotoneSpline) << choice->reason;
  EXPECT_LT(choice->best.leave_one_out_rms_relative, 0.01);
  EXPECT_THAT(choice->best.termination, HasSubstr("knots on the residual of a gamma fit"));
  const size_t knots = choice->best.activation.warp.Knots().size();
  EXPECT_EQ(choice->best.parameters.size(), 4 + knots - 1);
  EXPECT_EQ(choice->best.covariance.size(),
            choice->best.parameters.size() * choice->best.parameters.size());
}

TEST(ActivationModelsTest, SplineNeedsEightDrives) {
  const auto fit = FitActivation(SimulateSeries({1, 100, 0, 2.2}, 7, 0.01),
                                 ActivationModel::kMonotoneSpline, Weighting::kRelative);
  EXPECT_TRUE(absl::IsFailedPrecondition(fit.status()));
  EXPECT_THAT(std::string(fit.status().message()), HasSubstr("needs 8 different drive values"));
}

// The scatter of refits with the same number of knots, against the stated band.
void ExpectBandOfBootstrap(const Activation& truth, ActivationModel model) {
  constexpr int kSeries = 100;
  const std::vector<double> drives = {0, 0.15, 0.5, 0.83, 1};
  const auto fit = FitActivation(SimulateSeries(truth, 17, 0.01), model, Weighting::kMeasuredSigma);
  ASSERT_TRUE(fit.ok()) << fit.status();
  const double scale = std::sqrt(std::max(fit->chi_square / fit->degrees_of_freedom, 1.0));
  std::vector<double> squares(drives.size(), 0.0);
  for (uint64_t seed = 0; seed < kSeries; ++seed) {
    ActivationProblem problem{model, {}};
    for (const LevelReading& r : SimulateSeries(fit->activation, 17, 0.01, 100 + seed).readings) {
      problem.readings.push_back({r.drive, r.luminance, 1 / r.luminance_sigma});
    }
    auto refit = SolveActivation(problem, StartingPoints(problem));
    ASSERT_TRUE(refit.ok()) << refit.status();
    if (model == ActivationModel::kMonotoneSpline) {
      refit = SolveSpline(problem, refit->activation,
                          static_cast<int>(fit->activation.warp.Knots().size()));
      ASSERT_TRUE(refit.ok()) << refit.status();
    }
    for (size_t i = 0; i < drives.size(); ++i) {
      squares[i] +=
          std::pow(refit->activation.Luminance(drives[i]) - fit->activation.Luminance(drives[i]),
                   2) /
          kSeries;
    }
  }
  for (size_t i = 0; i < drives.size(); ++i) {
    EXPECT_NEAR(std::sqrt(squares[i]) / (LuminanceSigma(*fit, drives[i]) / scale), 1, 0.3)
        << NameOf(model) << " at " << drives[i];
  }
}

TEST(ActivationModelsTest, BandIsThatOfABootstrap) {
  ExpectBandOfBootstrap({1, 400, 0.05, 2.2}, ActivationModel::kGammaWithCutoff);
  ExpectBandOfBootstrap({1, 400, 0, 2.4, 0.15}, ActivationModel::kSrgbLike);
  ExpectBandOfBootstrap(Bent(), ActivationModel::kMonotoneSpline);
}

TEST(ActivationModelsTest, EveryModelUnderEveryWeightingIsCompared) {
  EXPECT_EQ(CompareActivations(SimulateSeries({1, 100, 0.05, 2.2}, 11, 0.01)).size(), 12U);
  const auto compared = CompareActivations(SimulateSeries({1, 100, 0.05, 2.2}, 5, 0));
  ASSERT_EQ(compared.size(), 8U);
  EXPECT_TRUE(compared[0].fit.ok());
  EXPECT_FALSE(compared[3].fit.ok());
}

}  // namespace
}  // namespace eyebox::fit
