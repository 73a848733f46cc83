#include "service/results/activation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "capture/base/status.h"
#include "fit/base/conditioning.h"
#include "service/artifacts.h"
#include "service/results/parameter.h"

namespace eyebox::service {
namespace {

// Beyond this the model does not follow the display.
constexpr double kNotedLeaveOneOut = 0.02;

void AddLevels(const fit::ActivationFit& fit, v1::ActivationResult& result) {
  for (const fit::FittedLevel& level : fit.levels) {
    v1::LevelResidual& residual = *result.add_levels();
    residual.set_drive(level.reading.drive);
    residual.set_luminance(level.reading.luminance);
    residual.set_luminance_sigma(level.reading.luminance_sigma);
    residual.set_fitted(level.fitted);
    residual.set_relative_residual(level.relative_residual);
    residual.set_fitted_sigma(fit::LuminanceSigma(fit, level.reading.drive));
  }
}

void AddFigures(const fit::ActivationFit& fit, v1::ModelFigure& figure) {
  figure.set_model(std::string(fit::NameOf(fit.model)));
  figure.set_weighting(std::string(fit::NameOf(fit.weighting)));
  figure.set_leave_one_out_rms_relative(fit.leave_one_out_rms_relative);
  figure.set_rms_relative(fit.rms_relative);
  figure.set_aicc(fit.aicc);
}

void AddSpline(const fit::MonotoneWarp& warp, v1::ActivationResult& result) {
  for (const fit::MonotoneWarp::Knot& knot : warp.Knots()) {
    v1::SplineKnot& added = *result.add_spline();
    added.set_place(knot.x);
    added.set_log_slope(std::log(knot.slope / warp.Knots().back().slope));
  }
}

void AddAlternatives(const fit::ActivationChoice& choice, v1::ActivationResult& result) {
  for (const fit::ActivationFit& tried : choice.tried) {
    AddFigures(tried, *result.add_alternatives());
  }
  result.set_choice_reason(choice.reason);
}

void AddWarnings(const fit::ActivationFit& fit, v1::ActivationResult& result) {
  if (fit.leave_one_out_rms_relative > kNotedLeaveOneOut) {
    result.add_warnings(absl::StrCat("levels are predicted to no better than ",
                                     100 * fit.leave_one_out_rms_relative,
                                     " % rms: look at the residuals before relying on the model"));
  }
  if (result.luminance_unit() == "relative") {
    result.add_warnings("no known luminance was recorded: luminances are relative");
  }
}

Image<float> AsMap(std::span<const float> values, ImageSize size) {
  Image<float> map(size);
  std::copy(values.begin(), values.end(), map.pixels().begin());
  return map;
}

absl::StatusOr<double> ValueOf(const v1::ActivationResult& result, std::string_view name,
                               std::string_view where) {
  for (const v1::Parameter& parameter : result.parameters()) {
    if (parameter.name() != name) continue;
    if (std::isfinite(parameter.value())) return parameter.value();
    return BadInput(where, absl::StrCat("parameter ", std::string(name), " is not finite"),
                    "fit again");
  }
  return BadInput(where, absl::StrCat("it holds no parameter ", std::string(name)),
                  "give what `eyebox fit --json` prints, or activation.json");
}

// Absent in results of models without a toe.
double ToeOf(const v1::ActivationResult& result) {
  for (const v1::Parameter& parameter : result.parameters()) {
    if (parameter.name() == "toe_drive") return parameter.value();
  }
  return 0;
}

absl::StatusOr<fit::MonotoneWarp> WarpOf(const v1::ActivationResult& result,
                                         std::string_view where) {
  if (result.spline().empty()) {
    if (result.model() != fit::NameOf(fit::ActivationModel::kMonotoneSpline)) {
      return fit::MonotoneWarp();
    }
    return BadInput(where, "it is a monotone_spline without knots",
                    "give what `eyebox fit --json` prints, or activation.json");
  }
  std::vector<double> places;
  std::vector<double> log_slopes;
  for (const v1::SplineKnot& knot : result.spline()) {
    places.push_back(knot.place());
    log_slopes.push_back(knot.log_slope());
  }
  if (fit::MonotoneWarp::IsValid(places, log_slopes)) {
    return fit::MonotoneWarp::FromLogSlopes(places, log_slopes);
  }
  return BadInput(absl::StrCat(std::string(where), ", spline"),
                  "its knots do not ascend from 0 to 1, or a slope is out of range",
                  "give what `eyebox fit --json` prints, or activation.json");
}

absl::Status OutOfRange(std::string_view where, const char* name, double value, const char* range) {
  return BadInput(where, absl::StrCat("parameter ", name, " is ", value),
                  absl::StrCat("it must be ", range));
}

}  // namespace

v1::ActivationResult DescribeActivation(const fit::ActivationChoice& choice,
                                        const fit::LevelSeries& series) {
  const fit::ActivationFit& fit = choice.best;
  v1::ActivationResult result;
  for (const fit::Parameter& parameter : fit.parameters) {
    AddParameter(*result.mutable_parameters(), parameter.name, parameter.value, parameter.sigma,
                 parameter.unit);
  }
  result.set_model(std::string(fit::NameOf(fit.model)));
  result.set_weighting(std::string(fit::NameOf(fit.weighting)));
  result.set_rms_relative(fit.rms_relative);
  result.set_leave_one_out_rms_relative(fit.leave_one_out_rms_relative);
  result.set_aicc(fit.aicc);
  result.set_chi_square(fit.chi_square);
  result.set_degrees_of_freedom(fit.degrees_of_freedom);
  result.mutable_covariance()->Add(fit.covariance.begin(), fit.covariance.end());
  result.set_condition_number(fit::ConditionNumber(fit.covariance));
  AddLevels(fit, result);
  result.set_luminance_unit(series.luminance_unit);
  result.set_scale_relative_sigma(series.scale_relative_sigma);
  AddAlternatives(choice, result);
  AddSpline(fit.activation.warp, result);
  result.set_termination(fit.termination);
  result.set_source(series.source);
  AddWarnings(fit, result);
  return result;
}

absl::StatusOr<v1::CommonExponentResult> DescribeField(const fit::CommonExponentFit& fit,
                                                       const MeasuredLevels& levels,
                                                       const std::filesystem::path& folder) {
  v1::CommonExponentResult result;
  AddParameter(*result.mutable_parameters(), "gamma", fit.gamma, fit.gamma_sigma, "1");
  result.set_locations(static_cast<int32_t>(fit.locations));
  result.set_levels(static_cast<int32_t>(levels.drives.size()));
  result.set_degrees_of_freedom(fit.degrees_of_freedom);
  result.set_rms_relative(fit.rms_relative);
  result.set_termination(fit.termination);
  struct Map {
    const char* file;
    const char* name;
    std::span<const float> values;
  };
  const std::array<Map, 4> maps = {Map{"field_k.npy", "k", fit.gain},
                                   Map{"field_k_sigma.npy", "k_sigma", fit.gain_sigma},
                                   Map{"field_delta.npy", "delta", fit.offset},
                                   Map{"field_delta_sigma.npy", "delta_sigma", fit.offset_sigma}};
  for (const Map& map : maps) {
    EYEBOX_ASSIGN_OR_RETURN(*result.add_maps(),
                            WriteMap(folder, map.file, map.name, levels.series.luminance_unit,
                                     AsMap(map.values, levels.size)));
  }
  return result;
}

void AddComparison(const std::vector<fit::ComparedActivation>& compared,
                   v1::ActivationResult& result) {
  for (const fit::ComparedActivation& entry : compared) {
    v1::ModelFigure& figure = *result.add_comparison();
    if (entry.fit.ok()) {
      AddFigures(*entry.fit, figure);
      continue;
    }
    figure.set_model(std::string(fit::NameOf(entry.model)));
    figure.set_weighting(std::string(fit::NameOf(entry.weighting)));
    figure.set_failure(std::string(entry.fit.status().message()));
  }
}

v1::Parameter MaximumLuminance(const v1::ActivationResult& activation) {
  v1::Parameter maximum;
  maximum.set_name("maximum_luminance");
  maximum.set_unit(activation.luminance_unit());
  if (activation.parameters_size() < 2) return maximum;
  maximum.set_value(activation.parameters(0).value() + activation.parameters(1).value());
  double variance = 0;
  const int count = activation.parameters_size();
  if (activation.covariance_size() == count * count) {
    variance =
        activation.covariance(0) + activation.covariance(count + 1) + 2 * activation.covariance(1);
  }
  maximum.set_sigma(std::sqrt(std::max(variance, 0.0)));
  return maximum;
}

absl::StatusOr<fit::Activation> ActivationOf(const v1::ActivationResult& result,
                                             std::string_view where) {
  fit::Activation activation;
  EYEBOX_ASSIGN_OR_RETURN(activation.minimum_luminance,
                          ValueOf(result, "minimum_luminance", where));
  EYEBOX_ASSIGN_OR_RETURN(activation.luminance_range, ValueOf(result, "luminance_range", where));
  EYEBOX_ASSIGN_OR_RETURN(activation.cutoff_drive, ValueOf(result, "cutoff_drive", where));
  EYEBOX_ASSIGN_OR_RETURN(activation.gamma, ValueOf(result, "gamma", where));
  if (!(activation.minimum_luminance >= 0)) {
    return OutOfRange(where, "minimum_luminance", activation.minimum_luminance, "at least 0");
  }
  if (!(activation.luminance_range > 0)) {
    return OutOfRange(where, "luminance_range", activation.luminance_range, "above 0");
  }
  if (!(activation.cutoff_drive >= 0 && activation.cutoff_drive < 1)) {
    return OutOfRange(where, "cutoff_drive", activation.cutoff_drive, "from 0 to below 1");
  }
  if (!(activation.gamma > 0)) return OutOfRange(where, "gamma", activation.gamma, "above 0");
  activation.toe_drive = ToeOf(result);
  if (!(activation.toe_drive >= 0 && activation.toe_drive < 1)) {
    return OutOfRange(where, "toe_drive", activation.toe_drive, "from 0 to below 1");
  }
  EYEBOX_ASSIGN_OR_RETURN(activation.warp, WarpOf(result, where));
  return activation;
}

}  // namespace eyebox::service
