// From the uncertainty of readings to that of a table's entries and of the luminance shown through
// it, by the law of propagation of uncertainty (JCGM 100:2008, 5.1 and 5.2).
#ifndef EYEBOX_FIT_BUDGET_LUMINANCE_BUDGET_H_
#define EYEBOX_FIT_BUDGET_LUMINANCE_BUDGET_H_

#include <span>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "fit/activation/fit_activation.h"
#include "fit/budget/budget_terms.h"

namespace eyebox::fit {

// What one term adds to each variance of a point, as a share of it; 0 where the variance is 0.
struct TermShare {
  std::string name;
  double drive = 0;
  double departure = 0;
  double luminance = 0;
};

// Of the rendered value `x`, a fraction of white.
struct BudgetPoint {
  double x = 0;
  // The drive value that the table gives: its entry, before it is encoded for the renderer.
  double drive = 0;
  double drive_sigma = 0;
  // Standard uncertainty of (L(drive) / (x L(1)) - 1): how far luminance may be from proportional,
  // whatever its scale. What the table itself leaves (its certificate) is not in it.
  double departure_sigma = 0;
  double luminance = 0;          // of the fit at that drive, unit of the fit
  double luminance_sigma = 0;    // scale included
  std::vector<TermShare> terms;  // by share of the luminance's variance, largest first
};

struct LuminanceBudget {
  std::vector<BudgetPoint> points;
  double condition_number = 1;  // of the fit, see ConditionNumber()
};

// x that a budget is usually stated for.
std::vector<double> UsualBudgetPoints();

// At the `x` above the display's minimum; those at or below it, where the table shows L0 whatever
// is asked, are left out. White is drive 1 by definition: its drive has no uncertainty.
// `terms` are those of BudgetTerms(). Errors: InvalidArgument (x outside (0, 1], terms of another
// number of readings), FailedPrecondition (no x above the minimum).
absl::StatusOr<LuminanceBudget> MakeLuminanceBudget(const ActivationFit& fit,
                                                    std::span<const BudgetTerm> terms,
                                                    std::span<const double> x);

}  // namespace eyebox::fit

#endif  // EYEBOX_FIT_BUDGET_LUMINANCE_BUDGET_H_
