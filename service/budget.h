// The uncertainty budget of a fit, as `eyebox run` keeps it and `eyebox fit --budget` writes it.
#ifndef EYEBOX_SERVICE_BUDGET_H_
#define EYEBOX_SERVICE_BUDGET_H_

#include <optional>
#include <span>
#include <string>

#include "absl/status/statusor.h"
#include "eyebox/v1/budget.pb.h"
#include "eyebox/v1/results.pb.h"
#include "fit/budget/budget_terms.h"
#include "fit/budget/monte_carlo.h"

namespace eyebox::service {

struct BudgetRequest {
  // Of each reading, from its reduction; empty: the readings' sigmas are one term.
  std::span<const fit::ReadingShares> shares = {};
  // Random trials to check the linear propagation with; none unless given.
  std::optional<fit::MonteCarloOptions> trials = std::nullopt;
};

// Errors: those of BudgetTerms(), MakeLuminanceBudget() and CheckBudget().
absl::StatusOr<v1::BudgetResult> MakeBudget(const fit::ActivationFit& fit,
                                            const fit::LevelSeries& series,
                                            const BudgetRequest& request);

// Of a fit as a message: its levels are fitted again with the same model and weights. `where` is
// for messages. Errors: as above, those of FitActivation(); InvalidArgument (a model or weighting
// of another name).
absl::StatusOr<v1::BudgetResult> BudgetOfResult(const v1::ActivationResult& result,
                                                const std::string& where,
                                                const BudgetRequest& request);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_BUDGET_H_
