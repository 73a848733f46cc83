#include "service/display.h"

#include <algorithm>

#include "absl/strings/str_cat.h"
#include "capture/base/file.h"
#include "capture/base/status.h"
#include "fit/color/colour_sigma.h"
#include "service/colour.h"
#include "service/result_json.h"
#include "service/results/activation.h"
#include "service/results/colour.h"

namespace eyebox::service {
namespace {

// Drives that differ by less are one grey.
constexpr double kGreyTolerance = 0.5 / 255;
constexpr size_t kLimitBytes = size_t{16} << 20;

absl::Status CheckCovariance(const std::string& file, size_t values, size_t parameters) {
  if (values == parameters * parameters) return absl::OkStatus();
  return BadInput(file + " covariance",
                  absl::StrCat("has ", values, " values for ", parameters, " parameters"),
                  "fit again");
}

absl::StatusOr<fit::ActivationFit> GreyFit(const v1::ActivationResult& result,
                                           const std::string& file) {
  fit::ActivationFit fit;
  EYEBOX_ASSIGN_OR_RETURN(fit.activation, ActivationOf(result, file));
  fit.covariance = {result.covariance().begin(), result.covariance().end()};
  EYEBOX_RETURN_IF_ERROR(
      CheckCovariance(file, fit.covariance.size(), static_cast<size_t>(result.parameters_size())));
  for (const auto model :
       {fit::ActivationModel::kPowerOffset, fit::ActivationModel::kGammaWithCutoff,
        fit::ActivationModel::kSrgbLike, fit::ActivationModel::kMonotoneSpline}) {
    if (result.model() != fit::NameOf(model)) continue;
    fit.model = model;
    return fit;
  }
  return BadInput(file + " model", "is '" + result.model() + "'", "fit again");
}

v1::Parameter Quantity(const std::string& name, double value, double sigma,
                       const std::string& unit) {
  v1::Parameter parameter;
  parameter.set_name(name);
  parameter.set_value(value);
  parameter.set_sigma(sigma);
  parameter.set_unit(unit);
  return parameter;
}

bool IsGrey(const optics::Rgb& drive) {
  const auto [least, most] = std::minmax_element(drive.begin(), drive.end());
  return *most - *least < kGreyTolerance;
}

}  // namespace

absl::StatusOr<Display> Display::Read(const std::filesystem::path& file) {
  EYEBOX_ASSIGN_OR_RETURN(const std::string json, ReadWholeFile(file, kLimitBytes));
  Display display;
  if (!IsColourFit(json)) {
    v1::ActivationResult result;
    EYEBOX_RETURN_IF_ERROR(ReadJson(file, result));
    EYEBOX_ASSIGN_OR_RETURN(display.answer_, GreyFit(result, file.string()));
    display.unit_ = result.luminance_unit();
    return display;
  }
  v1::ColourResult result;
  EYEBOX_RETURN_IF_ERROR(ReadJson(file, result));
  Colour colour;
  EYEBOX_ASSIGN_OR_RETURN(colour.model, ColourModelOf(result, file.string()));
  colour.covariance = {result.covariance().begin(), result.covariance().end()};
  EYEBOX_RETURN_IF_ERROR(
      CheckCovariance(file.string(), colour.covariance.size(), colour.model.ToParameters().size()));
  for (const v1::Parameter& parameter : result.parameters()) {
    if (parameter.name() == "background_y") display.unit_ = parameter.unit();
  }
  display.answer_ = std::move(colour);
  return display;
}

std::vector<std::string> Display::Quantities() const {
  if (std::holds_alternative<Colour>(answer_)) return {"x", "y", "z"};
  return {"luminance"};
}

std::vector<v1::Parameter> Display::Answer(const optics::Rgb& drive) const {
  if (const auto* colour = std::get_if<Colour>(&answer_)) {
    const fit::Xyz xyz = colour->model.Colour(drive);
    const fit::Xyz sigma = fit::ColourSigma(colour->model, colour->covariance, drive);
    std::vector<v1::Parameter> answer;
    const std::vector<std::string> names = Quantities();
    for (size_t c = 0; c < 3; ++c) answer.push_back(Quantity(names[c], xyz[c], sigma[c], unit_));
    return answer;
  }
  if (!IsGrey(drive)) return {};
  const auto& grey = std::get<fit::ActivationFit>(answer_);
  const double mean = (drive[0] + drive[1] + drive[2]) / 3;
  return {Quantity("luminance", grey.activation.Luminance(mean), fit::LuminanceSigma(grey, mean),
                   unit_)};
}

}  // namespace eyebox::service
