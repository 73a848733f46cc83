// The weighted least squares behind an activation fit: sum of (root_weight (L(v) - reading))^2.
#ifndef EYEBOX_FIT_ACTIVATION_ACTIVATION_PROBLEM_H_
#define EYEBOX_FIT_ACTIVATION_ACTIVATION_PROBLEM_H_

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

  size_t FewestDrives() const;         // different ones that the model needs, for leave-one-out too
  std::vector<double> Drives() const;  // ascending, each once
  double SumOfSquares(const Activation& activation) const;
  // All readings but those at the given drives.
  ActivationProblem Without(std::span<const double> drives) const;
};

struct ActivationSolution {
  Activation activation;
  Activation gamma_fit;  // a spline's first stage, which holds its v0 and gamma; else `activation`
  double sum_of_squares = 0;
  std::string termination;  // why the solver stopped and which parameter ended at a bound
};

// Relative errors are of at least this luminance: kRelativeFloor of the brightest reading.
double RelativeFloor(const LevelSeries& series);

// The problem that `fit` solved: its readings under its weights.
ActivationProblem ProblemOf(const ActivationFit& fit);

// dL/d(parameter) at `drive`, in the order of ActivationFit::parameters; 0 for those that the model
// holds.
std::vector<double> ParameterGradient(ActivationModel model, const Activation& activation,
                                      double drive);
// Places in that order of the parameters that the model leaves free.
std::vector<int> FreeParameters(ActivationModel model, const Activation& activation);

// A spread of gamma, cutoff and toe, each with the best L0 >= 0 and L1 > 0 for it.
std::vector<Activation> StartingPoints(const ActivationProblem& problem);

// The best optimum reached from any of `starts`, under L0 >= 0, L1 > 0, v0 >= 0, toe >= 0, gamma
// within its limits; of a spline's problem, the gamma fit with cutoff that it starts from.
// Errors: FailedPrecondition (converged from none of them).
absl::StatusOr<ActivationSolution> SolveActivation(const ActivationProblem& problem,
                                                   std::span<const Activation> starts);

// The spline of `knots` knots on what `gamma_fit` leaves: its v0 and gamma are held, L0, L1 and the
// slopes are fitted. Errors: FailedPrecondition (it did not converge).
absl::StatusOr<ActivationSolution> SolveSpline(const ActivationProblem& problem,
                                               const Activation& gamma_fit, int knots);

// The number of knots that predicts drives left out best; gamma is fitted anew without them.
// Errors: those of SolveActivation and SolveSpline.
absl::StatusOr<int> ChooseKnotCount(const ActivationProblem& problem, const Activation& gamma_fit,
                                    double floor);

// The whole procedure of the model: for a spline the gamma fit, the choice of knots, the spline.
// Leave-one-out repeats all of it, so that its error knows nothing of the reading left out.
// Errors: those of the parts.
absl::StatusOr<ActivationSolution> SolveModel(const ActivationProblem& problem,
                                              std::span<const Activation> starts, double floor);

// Covariance of the parameters, [parameters, parameters] row-major, zeros for one that is held, for
// readings whose sigma is 1 / root_weight. Of the two stages of a spline, the first passes its
// readings' errors on to the second; linear, so it holds where the gamma fit leaves a few percent.
// A parameter that ended at its bound counts as free: its sigma says how far the readings alone
// would let it leave the bound, and the others carry their share of that. Errors:
// FailedPrecondition (the readings do not determine the parameters).
absl::StatusOr<std::vector<double>> ActivationCovariance(const ActivationProblem& problem,
                                                         const ActivationSolution& solution);

// d(parameter) / d(luminance of a reading) where the fit stands, [parameters, readings] row-major,
// zeros for a parameter that is held. Errors: those of ActivationCovariance.
absl::StatusOr<std::vector<double>> ActivationResponse(const ActivationProblem& problem,
                                                       const ActivationSolution& solution);

// Rms over the interior drives of (predicted - measured) / max(measured, floor), each predicted
// from a fit without any reading at that drive. Errors: those of SolveModel.
absl::StatusOr<double> LeaveOneOutError(const ActivationProblem& problem, const Activation& fitted,
                                        double floor);

}  // namespace eyebox::fit

#endif  // EYEBOX_FIT_ACTIVATION_ACTIVATION_PROBLEM_H_
