// Whether the linear propagation of a budget may be trusted: the same by random trials
// (JCGM 101:2008, clause 8).
#ifndef EYEBOX_FIT_BUDGET_CHECK_BUDGET_H_
#define EYEBOX_FIT_BUDGET_CHECK_BUDGET_H_

#include <cstddef>
#include <span>
#include <vector>

#include "absl/status/statusor.h"
#include "fit/budget/luminance_budget.h"
#include "fit/budget/monte_carlo.h"

namespace eyebox::fit {

// One quantity of one point.
struct CheckedQuantity {
  double estimate = 0;  // of the linear propagation, with its sigma
  double sigma = 0;
  MonteCarloFigure trials;
  double low_difference = 0;   // ends of the two coverage intervals
  double high_difference = 0;  // apart, absolute
  double tolerance = 0;        // NumericalTolerance() of sigma
  // Both differences are within it. True for a sigma of 0, which nothing is drawn for.
  bool agrees = true;
};

struct CheckedPoint {
  double x = 0;
  CheckedQuantity drive, departure, luminance;
};

struct BudgetCheck {
  std::vector<CheckedPoint> points;
  size_t trials = 0;
  bool stable = false;     // the trials were enough for the comparison
  bool validated = false;  // stable, and all quantities agree
};

// Draws normal errors of `terms` around the fitted luminances, fits each series again with the same
// model and weights, and asks for the same quantities. `options.tolerance_share` of 1/5 is what the
// guide demands. Errors: those of Propagate(); InvalidArgument (points or terms of another fit).
absl::StatusOr<BudgetCheck> CheckBudget(const ActivationFit& fit, std::span<const BudgetTerm> terms,
                                        const LuminanceBudget& budget,
                                        const MonteCarloOptions& options);

}  // namespace eyebox::fit

#endif  // EYEBOX_FIT_BUDGET_CHECK_BUDGET_H_
