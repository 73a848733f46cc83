#include "fit/color/fit_colour.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "absl/strings/str_cat.h"
#include "capture/base/status.h"
#include "fit/color/colour_forward.h"
#include "fit/color/colour_problem.h"

namespace eyebox::fit {
namespace {

absl::StatusOr<ColourProblem> Pose(const ColourSeries& series, ColourModelKind kind, double floor) {
  EYEBOX_RETURN_IF_ERROR(series.Validate());
  ColourProblem problem{kind, series.readings, series.Largest(), {}, series.source};
  for (size_t c = 0; c < 3; ++c) problem.floor[c] = floor * problem.largest[c];
  const int values = static_cast<int>(3 * series.readings.size());
  if (values <= ParameterCount(kind)) {
    return Rejected(
        series.source,
        absl::StrCat("the ", std::string(NameOf(kind)), " colour model has ", ParameterCount(kind),
                     " parameters, and the series only ", values, " values"),
        "measure more stimuli");
  }
  return problem;
}

// Akaike's criterion for small samples; the estimated scale of the noise counts as a parameter.
double Aicc(const ColourFit& fit) {
  const double n = 3 * static_cast<double>(fit.stimuli.size());
  const double k = ParameterCount(fit.model.kind) + 1;
  if (n - k - 1 <= 0) return std::numeric_limits<double>::infinity();
  const double least = n * std::numeric_limits<double>::min();
  return n * std::log(std::max(fit.chi_square, least) / n) + 2 * k + 2 * k * (k + 1) / (n - k - 1);
}

// Mean square of the relative residuals above the floor, less what the parameters took of them.
// Those below it are quieter than their weights say and would make every sigma too small.
double NoiseScale(const ColourFit& fit) {
  double squares = 0;
  int count = 0;
  for (const FittedColour& stimulus : fit.stimuli) {
    for (size_t c = 0; c < 3; ++c) {
      if (!stimulus.counts[c]) continue;
      squares += stimulus.relative_residual[c] * stimulus.relative_residual[c];
      ++count;
    }
  }
  const double free_share =
      fit.degrees_of_freedom / (3.0 * static_cast<double>(fit.stimuli.size()));
  return squares / (std::max(count, 1) * free_share);
}

void ListParameters(ColourFit& fit) {
  const std::vector<std::string> names = ParameterNames(fit.model.kind);
  const std::vector<double> values = fit.model.ToParameters();
  const size_t n = names.size();
  for (size_t i = 0; i < n; ++i) {
    const bool is_colour = i >= kBackground && i < kInteraction;
    fit.parameters.push_back(
        {names[i], values[i], std::sqrt(fit.covariance[i * (n + 1)]), is_colour ? "cd/m2" : "1"});
  }
}

void ListStimuli(const ColourProblem& problem, const std::vector<Xyz>& left_out, ColourFit& fit) {
  for (size_t i = 0; i < problem.readings.size(); ++i) {
    const ColourReading& reading = problem.readings[i];
    FittedColour stimulus{reading, fit.model.Colour(reading.drive), {}, left_out[i], {}};
    const Xyz error = problem.RelativeError(fit.model, reading);
    for (size_t c = 0; c < 3; ++c) {
      stimulus.relative_residual[c] = -error[c];
      stimulus.counts[c] = reading.colour[c] > problem.floor[c];
    }
    fit.stimuli.push_back(stimulus);
  }
}

Xyz RmsOf(const std::vector<FittedColour>& stimuli, Xyz FittedColour::*errors) {
  Xyz rms = {};
  for (size_t c = 0; c < 3; ++c) {
    double squares = 0;
    int count = 0;
    for (const FittedColour& stimulus : stimuli) {
      if (!stimulus.counts[c]) continue;
      squares += (stimulus.*errors)[c] * (stimulus.*errors)[c];
      ++count;
    }
    if (count > 0) rms[c] = std::sqrt(squares / count);
  }
  return rms;
}

}  // namespace

double ColourFit::LeftOutError() const {
  const auto& [x, y, z] = leave_one_out_rms_relative;
  return std::sqrt((x * x + y * y + z * z) / 3);
}

absl::StatusOr<ColourFit> FitColour(const ColourSeries& series, ColourModelKind kind,
                                    double floor) {
  EYEBOX_ASSIGN_OR_RETURN(const ColourProblem problem, Pose(series, kind, floor));
  EYEBOX_ASSIGN_OR_RETURN(const std::vector<ColourModel> starts, ColourStartingPoints(problem));
  EYEBOX_ASSIGN_OR_RETURN(ColourSolution solution, SolveColour(problem, starts));
  EYEBOX_RETURN_IF_ERROR(solution.model.Validate(series.source));
  ColourFit fit;
  EYEBOX_ASSIGN_OR_RETURN(fit.covariance, ColourCovariance(problem, solution.model));
  fit.model = solution.model;
  fit.termination = std::move(solution.termination);
  fit.chi_square = solution.sum_of_squares;
  fit.degrees_of_freedom = static_cast<int>(3 * series.readings.size()) - ParameterCount(kind);
  EYEBOX_ASSIGN_OR_RETURN(const std::vector<Xyz> left_out, PredictLeftOut(problem, fit.model));
  ListStimuli(problem, left_out, fit);
  fit.rms_relative = RmsOf(fit.stimuli, &FittedColour::relative_residual);
  fit.leave_one_out_rms_relative = RmsOf(fit.stimuli, &FittedColour::left_out_error);
  const double scale = NoiseScale(fit);
  for (double& element : fit.covariance) element *= scale;
  ListParameters(fit);
  fit.aicc = Aicc(fit);
  return fit;
}

}  // namespace eyebox::fit
