// Where the uncertainty of an activation fit comes from, one independent source a term.
#ifndef EYEBOX_FIT_BUDGET_BUDGET_TERMS_H_
#define EYEBOX_FIT_BUDGET_BUDGET_TERMS_H_

#include <span>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "fit/activation/fit_activation.h"
#include "optics/reduce/bracket_report.h"

namespace eyebox::fit {

struct BudgetTerm {
  std::string name;
  // Standard uncertainty of the luminance of each reading, [readings], independent from one to the
  // next; empty where there is none.
  std::vector<double> reading_sigma;
  double common_relative_sigma = 0;  // of a factor that all readings share
};

// How the variance of one reading divides, as its reduction says.
struct ReadingShares {
  optics::VarianceBudget pixels;  // shares of the level's image; flat and scale are not looked at
  double drift_relative_sigma = 0;
};

// The terms of `fit`, whose series it came from. With the shares of each reading ([readings], or
// empty): photon, read, quantisation, dark, linearity, scatter and drift; without them "reading",
// the stated sigma. A fit without measured sigmas has "residual_scatter" instead, what its own
// residuals show. "lack_of_fit" is what residuals show beyond the sigmas; "flat", "scatter_common"
// and "scale" are common to all readings. Together they make up the covariance of the fit.
// Errors: InvalidArgument (another number of shares or readings than the fit has).
absl::StatusOr<std::vector<BudgetTerm>> BudgetTerms(const ActivationFit& fit,
                                                    const LevelSeries& series,
                                                    std::span<const ReadingShares> shares = {});

}  // namespace eyebox::fit

#endif  // EYEBOX_FIT_BUDGET_BUDGET_TERMS_H_
