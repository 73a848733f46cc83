#include "fit/activation/fit_activation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "absl/strings/str_cat.h"
#include "capture/base/status.h"
#include "fit/activation/activation_problem.h"
#include "fit/base/relative_floor.h"

namespace eyebox::fit {
namespace {

double White(const LevelSeries& series) {
  double white = 0;
  for (const LevelReading& reading : series.readings) white = std::max(white, reading.luminance);
  return white;
}

double RootWeight(const LevelReading& reading, Weighting weighting, double floor) {
  if (weighting == Weighting::kMeasuredSigma) return 1 / reading.luminance_sigma;
  if (weighting == Weighting::kRelative) return 1 / std::max(reading.luminance, floor);
  return 1;
}

absl::Status CheckSigmas(const LevelSeries& series) {
  for (size_t i = 0; i < series.readings.size(); ++i) {
    if (series.readings[i].luminance_sigma > 0) continue;
    return BadInput(absl::StrCat(series.source, ", reading ", i + 1),
                    "it has no standard uncertainty to be weighted with",
                    "give one above 0 for every reading, or weight relatively");
  }
  return absl::OkStatus();
}

ActivationProblem WeightedProblem(const LevelSeries& series, ActivationModel model,
                                  Weighting weighting) {
  ActivationProblem problem{model, {}};
  for (const LevelReading& reading : series.readings) {
    problem.readings.push_back(
        {reading.drive, reading.luminance, RootWeight(reading, weighting, RelativeFloor(series))});
  }
  return problem;
}

absl::StatusOr<ActivationProblem> Pose(const LevelSeries& series, ActivationModel model,
                                       Weighting weighting) {
  EYEBOX_RETURN_IF_ERROR(series.Validate());
  if (weighting == Weighting::kMeasuredSigma) EYEBOX_RETURN_IF_ERROR(CheckSigmas(series));
  const ActivationProblem problem = WeightedProblem(series, model, weighting);
  const size_t drives = problem.Drives().size();
  if (drives < problem.FewestDrives()) {
    return Rejected(series.source,
                    absl::StrCat(std::string(NameOf(model)), " needs ", problem.FewestDrives(),
                                 " different drive values, and the series has only ", drives),
                    "measure more levels");
  }
  return problem;
}

absl::Status CheckExponent(const LevelSeries& series, const ActivationSolution& solution) {
  const double gamma = solution.activation.gamma;
  if (gamma > kGammaMin * (1 + 1e-6) && gamma < kGammaMax * (1 - 1e-6)) return absl::OkStatus();
  return Rejected(series.source,
                  absl::StrCat("the best exponent lies at the limit of ", kGammaMin, " to ",
                               kGammaMax, ": no activation of a display has this form"),
                  "check the order of the levels and the readings between black and white");
}

// Akaike's criterion for small samples; an estimated scale of the noise counts as a parameter.
double Aicc(const ActivationFit& fit, int free_parameters) {
  const auto n = static_cast<double>(fit.levels.size());
  const bool scale_is_known = fit.weighting == Weighting::kMeasuredSigma;
  const double k = free_parameters + (scale_is_known ? 0 : 1);
  if (n - k - 1 <= 0) return std::numeric_limits<double>::infinity();
  const double least = n * std::numeric_limits<double>::min();
  const double misfit =
      scale_is_known ? fit.chi_square : n * std::log(std::max(fit.chi_square, least) / n);
  return misfit + 2 * k + 2 * k * (k + 1) / (n - k - 1);
}

void ScaleCovariance(const LevelSeries& series, ActivationFit& fit) {
  double scale = fit.chi_square / fit.degrees_of_freedom;
  if (fit.weighting == Weighting::kMeasuredSigma) scale = std::max(scale, 1.0);
  for (double& element : fit.covariance) element *= scale;
  const double luminances[] = {fit.activation.minimum_luminance, fit.activation.luminance_range};
  const double scale_variance = series.scale_relative_sigma * series.scale_relative_sigma;
  const size_t count = fit.parameters.size();
  for (int i = 0; i < 2; ++i) {
    for (int j = 0; j < 2; ++j) {
      fit.covariance[count * i + j] += scale_variance * luminances[i] * luminances[j];
    }
  }
}

void ListParameters(const LevelSeries& series, ActivationFit& fit) {
  const Activation& a = fit.activation;
  fit.parameters = {{"minimum_luminance", a.minimum_luminance, 0, series.luminance_unit},
                    {"luminance_range", a.luminance_range, 0, series.luminance_unit},
                    {"cutoff_drive", a.cutoff_drive, 0, "1"},
                    {"gamma", a.gamma, 0, "1"}};
  if (fit.model == ActivationModel::kSrgbLike) {
    fit.parameters.push_back({"toe_drive", a.toe_drive, 0, "1"});
  }
  const std::vector<MonotoneWarp::Knot>& knots = a.warp.Knots();
  for (size_t i = 0; i + 1 < knots.size(); ++i) {
    fit.parameters.push_back({absl::StrCat("spline_log_slope_", i + 1),
                              std::log(knots[i].slope / knots.back().slope), 0, "1"});
  }
}

void SetSigmas(ActivationFit& fit) {
  const size_t count = fit.parameters.size();
  for (size_t i = 0; i < count; ++i) {
    fit.parameters[i].sigma = std::sqrt(fit.covariance[(count + 1) * i]);
  }
}

void ListLevels(const LevelSeries& series, ActivationFit& fit) {
  const double floor = RelativeFloor(series);
  double sum = 0;
  for (const LevelReading& reading : series.readings) {
    const double fitted = fit.activation.Luminance(reading.drive);
    const double residual = reading.luminance - fitted;
    fit.levels.push_back({reading, fitted, residual / std::max(fitted, floor)});
    const double relative = residual / std::max(reading.luminance, floor);
    sum += relative * relative;
  }
  fit.rms_relative = std::sqrt(sum / static_cast<double>(fit.levels.size()));
}

}  // namespace

double RelativeFloor(const LevelSeries& series) { return kRelativeFloor * White(series); }

std::string_view NameOf(ActivationModel model) {
  switch (model) {
    case ActivationModel::kPowerOffset:
      return "power_offset";
    case ActivationModel::kSrgbLike:
      return "srgb_like";
    case ActivationModel::kMonotoneSpline:
      return "monotone_spline";
    case ActivationModel::kGammaWithCutoff:
      break;
  }
  return "gamma_with_cutoff";
}

std::string_view NameOf(Weighting weighting) {
  if (weighting == Weighting::kMeasuredSigma) return "measured_sigma";
  return weighting == Weighting::kRelative ? "relative" : "unweighted";
}

absl::StatusOr<ActivationFit> FitActivation(const LevelSeries& series, ActivationModel model,
                                            Weighting weighting) {
  EYEBOX_ASSIGN_OR_RETURN(const ActivationProblem problem, Pose(series, model, weighting));
  const double floor = RelativeFloor(series);
  EYEBOX_ASSIGN_OR_RETURN(ActivationSolution solution,
                          SolveModel(problem, StartingPoints(problem), floor));
  EYEBOX_RETURN_IF_ERROR(CheckExponent(series, solution));
  ActivationFit fit;
  fit.activation = solution.activation;
  fit.model = model;
  fit.weighting = weighting;
  fit.termination = solution.termination;
  fit.chi_square = solution.sum_of_squares;
  const auto free = static_cast<int>(FreeParameters(model, fit.activation).size());
  fit.degrees_of_freedom = static_cast<int>(series.readings.size()) - free;
  EYEBOX_ASSIGN_OR_RETURN(fit.covariance, ActivationCovariance(problem, solution));
  EYEBOX_ASSIGN_OR_RETURN(fit.response, ActivationResponse(problem, solution));
  ListParameters(series, fit);
  ScaleCovariance(series, fit);
  SetSigmas(fit);
  ListLevels(series, fit);
  fit.aicc = Aicc(fit, free);
  EYEBOX_ASSIGN_OR_RETURN(fit.leave_one_out_rms_relative,
                          LeaveOneOutError(problem, solution.gamma_fit, floor));
  return fit;
}

ActivationProblem ProblemOf(const ActivationFit& fit) {
  LevelSeries series;
  for (const FittedLevel& level : fit.levels) series.readings.push_back(level.reading);
  return WeightedProblem(series, fit.model, fit.weighting);
}

double LuminanceSigma(const ActivationFit& fit, double drive) {
  const std::vector<double> gradient = ParameterGradient(fit.model, fit.activation, drive);
  const size_t count = gradient.size();
  double variance = 0;
  for (size_t i = 0; i < count; ++i) {
    for (size_t j = 0; j < count; ++j) {
      variance += gradient[i] * fit.covariance[count * i + j] * gradient[j];
    }
  }
  return std::sqrt(std::max(variance, 0.0));
}

}  // namespace eyebox::fit
