// The weighted least squares behind a colour fit: sum of ((x(v) - reading) / max(reading, floor))^2
// over X, Y and Z of all readings.
#ifndef EYEBOX_FIT_COLOR_COLOUR_PROBLEM_H_
#define EYEBOX_FIT_COLOR_COLOUR_PROBLEM_H_

#include <span>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "fit/color/colour_model.h"
#include "fit/color/colour_series.h"

namespace eyebox::fit {

struct ColourProblem {
  ColourModelKind kind = ColourModelKind::kAdditive;
  std::vector<ColourReading> readings;
  Xyz largest = {};  // unit of X, Y, Z inside the solver
  Xyz floor = {};    // relative errors are taken of at least this
  std::string source;

  // (modelled - measured) / max(measured, floor).
  Xyz RelativeError(const ColourModel& model, const ColourReading& reading) const;
  double SumOfSquares(const ColourModel& model) const;
};

struct ColourSolution {
  ColourModel model;
  double sum_of_squares = 0;
  std::string termination;
};

// A spread of cutoffs and gammas, each with the best background and primaries for it.
// Errors: FailedPrecondition (the stimuli do not tell the channels apart).
absl::StatusOr<std::vector<ColourModel>> ColourStartingPoints(const ColourProblem& problem);

// The best optimum reached from any of `starts`: primaries, background, activations and interaction
// together, under z >= 0, 0 <= v0 <= 0.5, 0.3 <= gamma <= 8.
// Errors: FailedPrecondition (converged from none of them).
absl::StatusOr<ColourSolution> SolveColour(const ColourProblem& problem,
                                           std::span<const ColourModel> starts);

// (J^T W J)^-1 in the order of ParameterNames, row-major, [n, n]. A parameter at its bound counts
// as free. Errors: FailedPrecondition (the readings do not determine the parameters).
absl::StatusOr<std::vector<double>> ColourCovariance(const ColourProblem& problem,
                                                     const ColourModel& model);

// [readings, 3] relative errors, each predicted by a fit without any reading of that stimulus.
// Errors: those of SolveColour.
absl::StatusOr<std::vector<Xyz>> PredictLeftOut(const ColourProblem& problem,
                                                const ColourModel& fitted);

}  // namespace eyebox::fit

#endif  // EYEBOX_FIT_COLOR_COLOUR_PROBLEM_H_
