#include "service/results/colour.h"

#include <cmath>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "capture/base/status.h"
#include "fit/base/conditioning.h"
#include "service/results/parameter.h"

namespace eyebox::service {
namespace {

v1::Tristimulus ToProto(const fit::Xyz& xyz) {
  v1::Tristimulus message;
  message.set_x(xyz[0]);
  message.set_y(xyz[1]);
  message.set_z(xyz[2]);
  return message;
}

v1::ChannelTriplet DriveToProto(const fit::Rgb& drive) {
  v1::ChannelTriplet message;
  message.set_r(drive[0]);
  message.set_g(drive[1]);
  message.set_b(drive[2]);
  return message;
}

void AddStimuli(const fit::ColourFit& fit, v1::ColourResult& result) {
  for (const fit::FittedColour& stimulus : fit.stimuli) {
    v1::ColourResidual& residual = *result.add_stimuli();
    *residual.mutable_drive() = DriveToProto(stimulus.reading.drive);
    *residual.mutable_measured() = ToProto(stimulus.reading.colour);
    *residual.mutable_fitted() = ToProto(stimulus.fitted);
    *residual.mutable_relative_residual() = ToProto(stimulus.relative_residual);
    *residual.mutable_left_out_error() = ToProto(stimulus.left_out_error);
  }
}

void AddAlternatives(const fit::ColourChoice& choice, v1::ColourResult& result) {
  for (const fit::ColourFit& tried : choice.tried) {
    v1::ColourModelFigure& figure = *result.add_alternatives();
    figure.set_model(std::string(fit::NameOf(tried.model.kind)));
    figure.set_parameter_count(fit::ParameterCount(tried.model.kind));
    *figure.mutable_rms_relative() = ToProto(tried.rms_relative);
    *figure.mutable_leave_one_out_rms_relative() = ToProto(tried.leave_one_out_rms_relative);
    figure.set_aicc(tried.aicc);
  }
  result.set_choice_reason(choice.reason);
}

v1::AdditivityResult ToProto(const fit::AdditivityTest& test) {
  v1::AdditivityResult result;
  result.set_tested(test.tested);
  result.set_passed(test.passed);
  result.set_verdict(test.verdict);
  *result.mutable_mean_departure() = ToProto(test.mean_departure);
  *result.mutable_standard_error() = ToProto(test.standard_error);
  *result.mutable_rms_departure() = ToProto(test.rms_departure);
  result.set_max_departure(test.max_departure);
  result.set_at_drive(test.at_drive);
  for (const fit::AdditivityLevel& level : test.levels) {
    v1::AdditivityLevel& message = *result.add_levels();
    message.set_drive(level.drive);
    *message.mutable_departure() = ToProto(level.departure);
  }
  return result;
}

void AddConstancy(const fit::ColourChoice& choice, v1::ColourResult& result) {
  for (size_t k = 0; k < 3; ++k) {
    const fit::ConstancyTest& test = choice.constancy[k];
    v1::ConstancyResult& message = *result.add_constancy();
    message.set_channel(fit::kChannelNames[k]);
    message.set_tested(test.tested);
    message.set_passed(test.passed);
    message.set_max_distance(test.max_distance);
    message.set_at_drive(test.at_drive);
    message.set_rms_distance(test.rms_distance);
  }
}

absl::StatusOr<double> ValueOf(const v1::ColourResult& result, const std::string& name,
                               std::string_view where) {
  for (const v1::Parameter& parameter : result.parameters()) {
    if (parameter.name() == name) return parameter.value();
  }
  return BadInput(where, absl::StrCat("it holds no parameter ", name),
                  "give what `eyebox fit --csv --json` prints for a series of colours");
}

}  // namespace

v1::ColourResult DescribeColour(const fit::ColourChoice& choice) {
  const fit::ColourFit& fit = choice.best;
  v1::ColourResult result;
  for (const fit::Parameter& parameter : fit.parameters) {
    AddParameter(*result.mutable_parameters(), parameter.name, parameter.value, parameter.sigma,
                 parameter.unit);
  }
  result.set_model(std::string(fit::NameOf(fit.model.kind)));
  result.set_colour_certified(choice.certified);
  result.set_verdict(choice.verdict);
  *result.mutable_rms_relative() = ToProto(fit.rms_relative);
  *result.mutable_leave_one_out_rms_relative() = ToProto(fit.leave_one_out_rms_relative);
  *result.mutable_additivity() = ToProto(choice.additivity);
  AddConstancy(choice, result);
  AddAlternatives(choice, result);
  result.mutable_covariance()->Add(fit.covariance.begin(), fit.covariance.end());
  result.set_condition_number(fit::ConditionNumber(fit.covariance));
  result.set_chi_square(fit.chi_square);
  result.set_degrees_of_freedom(fit.degrees_of_freedom);
  result.set_aicc(fit.aicc);
  result.set_termination(fit.termination);
  AddStimuli(fit, result);
  if (!choice.certified) result.add_warnings(choice.verdict);
  if (!choice.mixtures_measured && fit.model.kind != fit::ColourModelKind::kAdditive) {
    result.add_warnings(
        "no mixture of channels but grey was measured: that both neighbours of a channel act alike "
        "is assumed, so measure some mixtures of two channels");
  }
  return result;
}

absl::StatusOr<fit::ColourModel> ColourModelOf(const v1::ColourResult& result,
                                               std::string_view where) {
  const absl::StatusOr<fit::ColourModelKind> kind = fit::ColourModelKindOf(result.model());
  if (!kind.ok()) {
    return BadInput(where, absl::StrCat("there is no colour model '", result.model(), "'"),
                    "fit again with this version");
  }
  std::vector<double> values;
  for (const std::string& name : fit::ParameterNames(*kind)) {
    EYEBOX_ASSIGN_OR_RETURN(const double value, ValueOf(result, name, where));
    values.push_back(value);
  }
  const fit::ColourModel model = fit::ColourModel::FromParameters(*kind, values);
  EYEBOX_RETURN_IF_ERROR(model.Validate(where));
  return model;
}

}  // namespace eyebox::service
