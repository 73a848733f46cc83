// From readings to drive values and luminance: shares, sensitivities, and random trials.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "fit/budget/budget_terms.h"
#include "fit/budget/check_budget.h"
#include "fit/budget/luminance_budget.h"
#include "fit/cube/goal.h"
#include "tests/fit/activation/simulated_series.h"

namespace eyebox::fit {
namespace {

constexpr Activation kDisplay = {0.8, 120, 0.03, 2.2};

ActivationFit FitOf(const LevelSeries& series, ActivationModel model, Weighting weighting) {
  auto fit = FitActivation(series, model, weighting);
  EXPECT_TRUE(fit.ok()) << fit.status();
  return *std::move(fit);
}

LuminanceBudget BudgetOf(const ActivationFit& fit, const LevelSeries& series,
                         std::span<const ReadingShares> shares = {}) {
  const auto terms = BudgetTerms(fit, series, shares);
  EXPECT_TRUE(terms.ok()) << terms.status();
  auto budget = MakeLuminanceBudget(fit, *terms, UsualBudgetPoints());
  EXPECT_TRUE(budget.ok()) << budget.status();
  return *std::move(budget);
}

TEST(BudgetTest, TermsMakeUpTheCovarianceOfTheFit) {
  for (const ActivationModel model :
       {ActivationModel::kPowerOffset, ActivationModel::kGammaWithCutoff,
        ActivationModel::kSrgbLike, ActivationModel::kMonotoneSpline}) {
    for (const Weighting weighting :
         {Weighting::kMeasuredSigma, Weighting::kRelative, Weighting::kUnweighted}) {
      LevelSeries series = SimulateSeries(kDisplay, 17, 0.004);
      series.scale_relative_sigma = 0.01;
      series.flat_relative_sigma = 0.003;
      const ActivationFit fit = FitOf(series, model, weighting);
      for (const BudgetPoint& point : BudgetOf(fit, series).points) {
        EXPECT_NEAR(point.luminance_sigma / LuminanceSigma(fit, point.drive), 1, 1e-6)
            << NameOf(model) << ", " << NameOf(weighting) << ", x " << point.x;
        double sum = 0;
        for (const TermShare& term : point.terms) sum += term.luminance;
        EXPECT_NEAR(sum, 1, 1e-12);
      }
    }
  }
}

TEST(BudgetTest, TheScaleMovesLuminanceAndNoDriveValue) {
  LevelSeries series = SimulateSeries(kDisplay, 17, 0.001);
  series.scale_relative_sigma = 0.05;
  const ActivationFit fit =
      FitOf(series, ActivationModel::kGammaWithCutoff, Weighting::kMeasuredSigma);
  for (const BudgetPoint& point : BudgetOf(fit, series).points) {
    EXPECT_EQ(point.terms.front().name, "scale");
    EXPECT_GT(point.terms.front().luminance, 0.95);
    EXPECT_LT(point.terms.front().drive, 1e-20);
    EXPECT_LT(point.terms.front().departure, 1e-20);
  }
}

TEST(BudgetTest, WhiteIsDriveOneByDefinition) {
  const LevelSeries series = SimulateSeries(kDisplay, 17, 0.002);
  const LuminanceBudget budget =
      BudgetOf(FitOf(series, ActivationModel::kGammaWithCutoff, Weighting::kMeasuredSigma), series);
  const BudgetPoint& white = budget.points.back();
  EXPECT_EQ(white.drive, 1);
  EXPECT_EQ(white.drive_sigma, 0);
  EXPECT_EQ(white.departure_sigma, 0);
  EXPECT_GT(white.luminance_sigma, 0);
}

TEST(BudgetTest, TheReductionsTermsShareTheReadingsVariance) {
  LevelSeries series = SimulateSeries(kDisplay, 17, 0.01);
  series.readings.back().luminance_sigma *= 3;
  const ActivationFit fit = FitOf(series, ActivationModel::kPowerOffset, Weighting::kMeasuredSigma);
  ReadingShares shares;
  shares.pixels = {.photon = 0.6, .read = 0.1, .quantisation = 0.05, .dark = 0.05, .flat = 0.2};
  shares.drift_relative_sigma = 0.004;
  const std::vector<ReadingShares> each(series.readings.size(), shares);
  const LuminanceBudget whole = BudgetOf(fit, series);
  const LuminanceBudget parts = BudgetOf(fit, series, each);
  for (size_t i = 0; i < whole.points.size(); ++i) {
    const BudgetPoint& point = parts.points[i];
    EXPECT_NEAR(point.luminance_sigma / whole.points[i].luminance_sigma, 1, 1e-12);
    double photon = 0;
    double read = 0;
    double drift = 0;
    for (const TermShare& term : point.terms) {
      if (term.name == "photon") photon = term.luminance;
      if (term.name == "read") read = term.luminance;
      if (term.name == "drift") drift = term.luminance;
      EXPECT_NE(term.name, "flat");  // it is not in the readings' sigma
    }
    EXPECT_NEAR(photon / read, 6, 1e-9);
    EXPECT_GT(drift, 0);
  }
}

// Against what the fit does when a reading moves.
TEST(BudgetTest, ResponseIsTheDerivativeOfTheFit) {
  for (const ActivationModel model :
       {ActivationModel::kPowerOffset, ActivationModel::kGammaWithCutoff}) {
    const LevelSeries series = SimulateSeries(kDisplay, 17, 0.002);
    const ActivationFit fit = FitOf(series, model, Weighting::kMeasuredSigma);
    const size_t readings = series.readings.size();
    for (const size_t j : {size_t{2}, size_t{16}}) {
      const double step = 0.05 * series.readings[j].luminance_sigma;
      LevelSeries above = series;
      LevelSeries below = series;
      above.readings[j].luminance += step;
      below.readings[j].luminance -= step;
      const ActivationFit high = FitOf(above, model, Weighting::kMeasuredSigma);
      const ActivationFit low = FitOf(below, model, Weighting::kMeasuredSigma);
      for (size_t k = 0; k < fit.parameters.size(); ++k) {
        if (fit.parameters[k].sigma == 0) continue;
        const double found = (high.parameters[k].value - low.parameters[k].value) / (2 * step);
        // The solver's curvature leaves out the residuals' own, 0.2 % here.
        const double scale = fit.parameters[k].sigma / series.readings[j].luminance_sigma;
        EXPECT_NEAR(fit.response[readings * k + j] / scale, found / scale, 0.03)
            << NameOf(model) << ", " << fit.parameters[k].name << ", reading " << j;
      }
    }
  }
}

TEST(BudgetTest, RandomTrialsConfirmTheLinearPropagation) {
  LevelSeries series = SimulateSeries(kDisplay, 9, 0.002);
  series.scale_relative_sigma = 0.01;
  const ActivationFit fit = FitOf(series, ActivationModel::kPowerOffset, Weighting::kMeasuredSigma);
  const auto terms = BudgetTerms(fit, series);
  ASSERT_TRUE(terms.ok());
  const double points[] = {0.1, 0.5, 1};
  const auto budget = MakeLuminanceBudget(fit, *terms, points);
  ASSERT_TRUE(budget.ok());
  const auto check = CheckBudget(fit, *terms, *budget, {.most_trials = 20000});
  ASSERT_TRUE(check.ok()) << check.status();
  for (const CheckedPoint& point : check->points) {
    for (const CheckedQuantity* quantity : {&point.drive, &point.departure, &point.luminance}) {
      EXPECT_TRUE(quantity->agrees) << point.x;
      if (quantity->sigma == 0) continue;
      EXPECT_NEAR(quantity->trials.sigma / quantity->sigma, 1, 0.03) << point.x;
    }
  }
  EXPECT_EQ(check->validated, check->stable);
}

// A black that its noise cannot tell from 0 has half of its distribution at the bound.
TEST(BudgetTest, RandomTrialsSeeWhereLinearPropagationFails) {
  LevelSeries series = SimulateSeries({0, 120, 0, 2.2}, 9, 0.002);
  for (LevelReading& reading : series.readings) {
    reading.luminance_sigma = std::hypot(reading.luminance_sigma, 0.05);
  }
  const ActivationFit fit = FitOf(series, ActivationModel::kPowerOffset, Weighting::kMeasuredSigma);
  const auto terms = BudgetTerms(fit, series);
  ASSERT_TRUE(terms.ok());
  const double points[] = {0.002};
  const auto budget = MakeLuminanceBudget(fit, *terms, points);
  ASSERT_TRUE(budget.ok());
  const auto check = CheckBudget(fit, *terms, *budget, {.most_trials = 10000});
  ASSERT_TRUE(check.ok()) << check.status();
  EXPECT_FALSE(check->points[0].luminance.agrees);
  EXPECT_FALSE(check->validated);
}

TEST(BudgetTest, WhatBelongsToAnotherFitIsRefused) {
  const LevelSeries series = SimulateSeries(kDisplay, 17, 0.002);
  const LevelSeries shorter = SimulateSeries(kDisplay, 9, 0.002);
  const ActivationFit fit = FitOf(series, ActivationModel::kPowerOffset, Weighting::kMeasuredSigma);
  EXPECT_FALSE(BudgetTerms(fit, shorter).ok());
  EXPECT_FALSE(BudgetTerms(fit, series, std::vector<ReadingShares>(3)).ok());
  const BudgetTerm other = {"reading", {1, 2, 3}, 0};
  const double x[] = {0.5};
  EXPECT_FALSE(MakeLuminanceBudget(fit, {&other, 1}, x).ok());
  const double outside[] = {1.5};
  EXPECT_FALSE(MakeLuminanceBudget(fit, {}, outside).ok());
  const double black[] = {1e-6};
  EXPECT_EQ(MakeLuminanceBudget(fit, {}, black).status().code(),
            absl::StatusCode::kFailedPrecondition);
}

}  // namespace
}  // namespace eyebox::fit
