#include <algorithm>
#include <cmath>

#include "capture/base/status.h"
#include "fit/activation/activation_problem.h"

namespace eyebox::fit {
absl::StatusOr<double> LeaveOneOutError(const ActivationProblem& problem, const Activation& fitted,
                                        double floor) {
  const std::vector<double> drives = problem.Drives();
  double sum = 0;
  int count = 0;
  for (size_t i = 1; i + 1 < drives.size(); ++i) {
    const ActivationProblem rest = problem.Without({&drives[i], 1});
    std::vector<Activation> starts = StartingPoints(rest);
    starts.push_back(fitted);
    EYEBOX_ASSIGN_OR_RETURN(const ActivationSolution solution, SolveModel(rest, starts, floor));
    for (const WeightedReading& reading : problem.readings) {
      if (reading.drive != drives[i]) continue;
      const double error = (solution.activation.Luminance(reading.drive) - reading.luminance) /
                           std::max(reading.luminance, floor);
      sum += error * error;
      ++count;
    }
  }
  return std::sqrt(sum / count);
}

}  // namespace eyebox::fit
