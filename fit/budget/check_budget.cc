#include "fit/budget/check_budget.h"

#include <algorithm>
#include <cmath>

#include "absl/strings/str_cat.h"
#include "capture/base/status.h"
#include "fit/activation/activation_problem.h"
#include "fit/cube/goal.h"

namespace eyebox::fit {
namespace {

// Half width of the coverage interval of a normal distribution over its sigma, by bisection of the
// error function.
double CoverageFactor(double coverage) {
  double low = 0;
  double high = 40;
  while (high - low > 1e-12) {
    const double middle = (low + high) / 2;
    (std::erf(middle / std::sqrt(2.0)) < coverage ? low : high) = middle;
  }
  return low;
}

// The series of one trial.
void DrawReadings(const ActivationFit& fit, std::span<const BudgetTerm> terms, RandomStream& random,
                  ActivationProblem& problem) {
  double factor = 1;
  for (size_t i = 0; i < problem.readings.size(); ++i) {
    problem.readings[i].luminance = fit.levels[i].fitted;
  }
  for (const BudgetTerm& term : terms) {
    if (term.common_relative_sigma > 0) factor += term.common_relative_sigma * DrawNormal(random);
    for (size_t i = 0; i < term.reading_sigma.size(); ++i) {
      problem.readings[i].luminance += term.reading_sigma[i] * DrawNormal(random);
    }
  }
  for (WeightedReading& reading : problem.readings) reading.luminance *= factor;
}

absl::StatusOr<ActivationSolution> FitAgain(const ActivationFit& fit,
                                            const ActivationProblem& problem) {
  Activation start = fit.activation;
  start.warp = {};
  EYEBOX_ASSIGN_OR_RETURN(ActivationSolution solution, SolveActivation(problem, {&start, 1}));
  if (fit.model != ActivationModel::kMonotoneSpline) return solution;
  return SolveSpline(problem, solution.activation,
                     static_cast<int>(fit.activation.warp.Knots().size()));
}

// Drive, departure and luminance of a point as a fit gives them; only those with a sigma.
void AddQuantities(const ActivationFit& fit, const BudgetPoint& point, const Activation& fitted,
                   size_t& next, std::span<double> quantities) {
  const Activation& truth = fit.activation;
  const double drive = DriveForLuminance(fitted, WantedLuminance(fitted, point.x));
  if (point.drive_sigma > 0) quantities[next++] = drive;
  if (point.departure_sigma > 0) quantities[next++] = RelativeError(truth, drive, point.x);
  if (point.luminance_sigma > 0) quantities[next++] = fitted.Luminance(point.drive);
}

size_t QuantitiesOf(const LuminanceBudget& budget) {
  size_t count = 0;
  for (const BudgetPoint& point : budget.points) {
    count += (point.drive_sigma > 0 ? 1 : 0) + (point.departure_sigma > 0 ? 1 : 0) +
             (point.luminance_sigma > 0 ? 1 : 0);
  }
  return count;
}

CheckedQuantity Compare(double estimate, double sigma, const MonteCarloResult& result,
                        const MonteCarloOptions& options, size_t& next) {
  CheckedQuantity checked;
  checked.estimate = estimate;
  checked.sigma = sigma;
  if (!(sigma > 0)) return checked;
  checked.trials = result.figures[next++];
  const double half = CoverageFactor(options.coverage) * sigma;
  checked.low_difference = std::abs(estimate - half - checked.trials.low);
  checked.high_difference = std::abs(estimate + half - checked.trials.high);
  checked.tolerance = NumericalTolerance(sigma, options.digits);
  checked.agrees = std::max(checked.low_difference, checked.high_difference) <= checked.tolerance;
  return checked;
}

}  // namespace

absl::StatusOr<BudgetCheck> CheckBudget(const ActivationFit& fit, std::span<const BudgetTerm> terms,
                                        const LuminanceBudget& budget,
                                        const MonteCarloOptions& options) {
  for (const BudgetTerm& term : terms) {
    if (term.reading_sigma.empty() || term.reading_sigma.size() == fit.levels.size()) continue;
    return BadInput(absl::StrCat("budget, term ", term.name), "it belongs to another fit",
                    "give the terms of this one");
  }
  ActivationProblem problem = ProblemOf(fit);
  const Trial trial = [&](RandomStream& random, std::span<double> quantities) {
    DrawReadings(fit, terms, random, problem);
    const absl::StatusOr<ActivationSolution> solution = FitAgain(fit, problem);
    if (!solution.ok()) return false;
    size_t next = 0;
    for (const BudgetPoint& point : budget.points) {
      AddQuantities(fit, point, solution->activation, next, quantities);
    }
    return true;
  };
  EYEBOX_ASSIGN_OR_RETURN(const MonteCarloResult result,
                          Propagate(QuantitiesOf(budget), trial, options));
  BudgetCheck check;
  check.trials = result.trials;
  check.stable = result.stable;
  check.validated = result.stable;
  size_t next = 0;
  for (const BudgetPoint& point : budget.points) {
    CheckedPoint checked;
    checked.x = point.x;
    checked.drive = Compare(point.drive, point.drive_sigma, result, options, next);
    checked.departure = Compare(0, point.departure_sigma, result, options, next);
    checked.luminance = Compare(point.luminance, point.luminance_sigma, result, options, next);
    check.validated = check.validated && checked.drive.agrees && checked.departure.agrees &&
                      checked.luminance.agrees;
    check.points.push_back(checked);
  }
  return check;
}

}  // namespace eyebox::fit
