// The weighted least squares behind an activation fit: sum of (root_weight (L(v) - reading))^2.
#ifndef EYEBOX_FIT_ACTIVATION_ACTIVATION_PROBLEM_H_
#define EYEBOX_FIT_ACTIVATION_ACTIVATION_PROBLEM_H_

#include <array>
#include <span>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "fit/activation/fit_activation.h"

namespace eyebox::fit {

// gamma is sought within these; an optimum at either is no activation of a display.
constexpr double kGammaMin = 0.3;
constexpr double kGammaMax = 8;

struct WeightedReading {
  double drive = 0;
  double luminance = 0;
  double root_weight = 1;  // reciprocal of the unit of luminance
};

struct ActivationProblem {
  ActivationModel model = ActivationModel::kGammaWithCutoff;
  std::vector<WeightedReading> readings;  // ascending drive

  int ParameterCount() const { return model == ActivationModel::kPowerOffset ? 3 : 4; }
  std::vector<double> Drives() const;  // ascending, each once
  double SumOfSquares(const Activation& activation) const;
};

struct ActivationSolution {
  Activation activation;
  double sum_of_squares = 0;
  std::string termination;  // why the solver stopped and which parameter ended at a bound
};

// A spread of gamma and cutoff, each with the best L0 >= 0 and L1 > 0 for it.
std::vector<Activation> StartingPoints(const ActivationProblem& problem);

// The best optimum reached from any of `starts`, under L0 >= 0, L1 > 0, v0 >= 0, gamma within its
// limits. Errors: FailedPrecondition (converged from none of them).
absl::StatusOr<ActivationSolution> SolveActivation(const ActivationProblem& problem,
                                                   std::span<const Activation> starts);

// (J^T W J)^-1 of the parameters (L0, L1, v0, gamma), [4, 4] row-major, zeros for a held v0. A
// parameter that ended at its bound counts as free: its sigma says how far the readings alone would
// let it leave the bound, and the others carry their share of that.
// Errors: FailedPrecondition (the readings do not determine the parameters).
absl::StatusOr<std::array<double, 16>> ActivationCovariance(const ActivationProblem& problem,
                                                            const Activation& activation);

// Rms over the interior drives of (predicted - measured) / max(measured, floor), each predicted
// from a fit without any reading at that drive. Errors: those of SolveActivation.
absl::StatusOr<double> LeaveOneOutError(const ActivationProblem& problem, const Activation& fitted,
                                        double floor);

}  // namespace eyebox::fit

#endif  // EYEBOX_FIT_ACTIVATION_ACTIVATION_PROBLEM_H_
