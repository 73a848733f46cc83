#include <algorithm>
#include <array>

#include "capture/base/status.h"
#include "fit/color/colour_problem.h"

namespace eyebox::fit {

absl::StatusOr<std::vector<Xyz>> PredictLeftOut(const ColourProblem& problem,
                                                const ColourModel& fitted) {
  std::vector<Xyz> errors(problem.readings.size());
  std::vector<Rgb> done;
  for (const ColourReading& left_out : problem.readings) {
    const Rgb& drive = left_out.drive;
    if (std::ranges::find(done, drive) != done.end()) continue;
    done.push_back(drive);
    ColourProblem rest = problem;
    std::erase_if(rest.readings, [&](const ColourReading& r) { return r.drive == drive; });
    EYEBOX_ASSIGN_OR_RETURN(const ColourSolution solution,
                            SolveColour(rest, std::array<ColourModel, 1>{fitted}));
    for (size_t i = 0; i < errors.size(); ++i) {
      if (problem.readings[i].drive != drive) continue;
      errors[i] = problem.RelativeError(solution.model, problem.readings[i]);
    }
  }
  return errors;
}

}  // namespace eyebox::fit
