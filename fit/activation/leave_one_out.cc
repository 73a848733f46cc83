#include <algorithm>
#include <cmath>

#include "capture/base/parallel.h"
#include "capture/base/status.h"
#include "fit/activation/activation_problem.h"

namespace eyebox::fit {
namespace {

// `fitted`, and of the spread the best gamma for each cutoff and toe: between two readings lies one
// optimum of the cutoff. All of the spread would change the error by less than 1 % of it.
std::vector<Activation> StartsWithout(const ActivationProblem& rest, const Activation& fitted) {
  struct Start {
    Activation activation;
    double squares;
  };
  std::vector<Start> best;
  for (const Activation& start : StartingPoints(rest)) {
    const double squares = rest.SumOfSquares(start);
    const auto same = std::ranges::find_if(best, [&](const Start& other) {
      return other.activation.cutoff_drive == start.cutoff_drive &&
             other.activation.toe_drive == start.toe_drive;
    });
    if (same == best.end()) {
      best.push_back({start, squares});
    } else if (squares < same->squares) {
      *same = {start, squares};
    }
  }
  std::vector<Activation> starts = {fitted};
  for (const Start& start : best) starts.push_back(start.activation);
  return starts;
}

absl::StatusOr<ActivationSolution> SolveWithout(const ActivationProblem& rest,
                                                const Activation& fitted, double floor) {
  auto solution = SolveModel(rest, StartsWithout(rest, fitted), floor);
  return solution.ok() ? std::move(solution) : SolveModel(rest, StartingPoints(rest), floor);
}

struct Errors {
  double squares = 0;
  int count = 0;
};

absl::StatusOr<Errors> ErrorsAt(double drive, const ActivationProblem& problem,
                                const Activation& fitted, double floor) {
  EYEBOX_ASSIGN_OR_RETURN(const ActivationSolution solution,
                          SolveWithout(problem.Without({&drive, 1}), fitted, floor));
  Errors errors;
  for (const WeightedReading& reading : problem.readings) {
    if (reading.drive != drive) continue;
    const double error = (solution.activation.Luminance(reading.drive) - reading.luminance) /
                         std::max(reading.luminance, floor);
    errors.squares += error * error;
    ++errors.count;
  }
  return errors;
}

}  // namespace

absl::StatusOr<double> LeaveOneOutError(const ActivationProblem& problem, const Activation& fitted,
                                        double floor) {
  const std::vector<double> drives = problem.Drives();
  std::vector<absl::StatusOr<Errors>> at(drives.size(), Errors());
  ForEachInParallel(static_cast<int>(drives.size()) - 2,
                    [&](int i) { at[i + 1] = ErrorsAt(drives[i + 1], problem, fitted, floor); });
  Errors total;
  for (const absl::StatusOr<Errors>& errors : at) {
    EYEBOX_RETURN_IF_ERROR(errors.status());
    total.squares += errors->squares;
    total.count += errors->count;
  }
  return std::sqrt(total.squares / total.count);
}

}  // namespace eyebox::fit
