#include "service/results/scatter.h"

#include <string>
#include <utility>

#include "absl/strings/str_cat.h"
#include "capture/base/status.h"
#include "fit/base/conditioning.h"
#include "service/result_json.h"
#include "service/results/parameter.h"

namespace eyebox::service {
namespace {

constexpr std::pair<optics::CoreShape, const char*> kCores[] = {
    {optics::CoreShape::kGaussian, "gaussian"}, {optics::CoreShape::kDisk, "disk"}};
constexpr std::pair<optics::TailShape, const char*> kTails[] = {
    {optics::TailShape::kMoffat, "moffat"}, {optics::TailShape::kPowerLaw, "power_law"}};

template <typename Shape, size_t kCount>
std::string NameOf(const std::pair<Shape, const char*> (&names)[kCount], Shape shape) {
  for (const auto& [known, name] : names) {
    if (known == shape) return name;
  }
  return "";
}

template <typename Shape, size_t kCount>
absl::StatusOr<Shape> ShapeOf(const std::pair<Shape, const char*> (&names)[kCount],
                              const std::string& name, const std::string& where) {
  std::string known_names;
  for (const auto& [known, known_name] : names) {
    if (name == known_name) return known;
    absl::StrAppend(&known_names, known_names.empty() ? "" : " or ", known_name);
  }
  return BadInput(where, absl::StrCat("is \"", name, "\""), absl::StrCat("give ", known_names));
}

std::string NameOf(fit::GlarePattern pattern) {
  return pattern == fit::GlarePattern::kBrightDisk ? "disk" : "black_disk";
}

void AddPrediction(const fit::PredictedReading& reading, v1::ScatterResult& result) {
  v1::PredictedPatch& patch = *result.add_predicted();
  patch.set_diameter_deg(reading.diameter_deg);
  patch.set_slope(reading.slope);
  patch.set_slope_sigma(reading.slope_sigma);
  patch.set_offset(reading.offset);
  patch.set_offset_sigma(reading.offset_sigma);
  patch.set_reading(reading.reading);
  patch.set_reading_sigma(reading.reading_sigma);
}

void AddReading(const fit::FittedGlareReading& fitted, v1::ScatterResult& result) {
  v1::FittedGlareReading& reading = *result.add_readings();
  reading.set_pattern(NameOf(fitted.reading.pattern));
  reading.set_diameter_deg(fitted.reading.diameter_deg);
  reading.set_offset_deg(fitted.reading.offset_deg);
  reading.set_luminance(fitted.reading.luminance);
  reading.set_luminance_sigma(fitted.reading.luminance_sigma);
  reading.set_fitted(fitted.fitted);
  reading.set_residual_sigmas(fitted.residual_sigmas);
}

void AddContrast(const char* name, double square_deg, const optics::ContrastFigure& contrast,
                 google::protobuf::RepeatedPtrField<v1::GlareFigure>& figures) {
  v1::GlareFigure& figure = *figures.Add();
  figure.set_name(name);
  figure.set_diameter_deg(square_deg);
  figure.set_value(contrast.contrast);
  figure.set_sigma(contrast.sigma);
  figure.set_floor(contrast.limit);
  figure.set_only_lower_bound(contrast.only_lower_bound);
}

}  // namespace

v1::ScatterKernel ToProto(const fit::KnownScatter& scatter, double glare_relative_sigma) {
  v1::ScatterKernel message;
  const optics::ScatterKernel& kernel = scatter.kernel;
  message.set_core(NameOf(kCores, kernel.core));
  message.set_tail(NameOf(kTails, kernel.tail));
  message.set_core_radius_deg(kernel.core_radius_deg);
  message.set_tail_share(kernel.tail_share);
  message.set_tail_radius_deg(kernel.tail_radius_deg);
  message.set_tail_exponent(kernel.tail_exponent);
  message.set_pedestal_share(kernel.pedestal_share);
  message.set_reach_deg(kernel.reach_deg);
  message.mutable_covariance()->Add(scatter.covariance.begin(), scatter.covariance.end());
  message.set_glare_relative_sigma(glare_relative_sigma);
  return message;
}

v1::ScatterResult DescribeScatter(const ScatterFindings& findings) {
  const fit::ScatterFit& fit = findings.fit;
  v1::ScatterResult result;
  for (const fit::Parameter& parameter : fit.parameters) {
    AddParameter(*result.mutable_parameters(), parameter.name, parameter.value, parameter.sigma,
                 parameter.unit);
  }
  AddParameter(*result.mutable_parameters(), "reach_deg", fit.kernel.reach_deg, fit.reach_sigma_deg,
               "deg");
  *result.mutable_kernel() = ToProto(fit.AsInstrument(), fit.glare_relative_sigma);
  result.set_kernel_of(findings.instrument ? "headset" : "headset_and_instrument");
  if (findings.instrument) {
    *result.mutable_instrument() =
        ToProto(findings.instrument->AsInstrument(), findings.instrument->glare_relative_sigma);
  }
  for (const fit::FittedGlareReading& reading : fit.readings) AddReading(reading, result);
  result.set_chi_square(fit.chi_square);
  result.set_degrees_of_freedom(fit.degrees_of_freedom);
  result.set_identifiability(fit.identifiability);
  result.set_condition_number(fit::ConditionNumber(fit.covariance));
  result.set_termination(fit.termination);
  for (const fit::PredictedReading& reading : findings.predicted) AddPrediction(reading, result);
  result.set_luminance_unit(findings.series.luminance_unit);
  result.set_source(findings.series.source);
  return result;
}

void AddGlareFigures(const MeasuredGlare& glare,
                     google::protobuf::RepeatedPtrField<v1::GlareFigure>& figures) {
  if (glare.full_field_contrast) {
    AddContrast("full_field_contrast", 0, *glare.full_field_contrast, figures);
  }
  for (const CheckerboardFigure& board : glare.checkerboards) {
    AddContrast("checkerboard_contrast", board.square_deg, board.seen, figures);
    if (!board.corrected) continue;
    AddContrast("checkerboard_contrast_of_display", board.square_deg, *board.corrected, figures);
  }
  for (const BlackSpotFigure& spot : glare.black_spots) {
    v1::GlareFigure& figure = *figures.Add();
    figure.set_name("black_spot_glare");
    figure.set_diameter_deg(spot.diameter_deg);
    figure.set_value(spot.glare.share);
    figure.set_sigma(spot.glare.sigma);
    figure.set_floor(spot.glare.floor);
    figure.set_instrument_share(spot.glare.instrument_share);
  }
}

void AddScatterRemoval(const optics::GlareRemovalFigures& figures, v1::ReduceResult& result) {
  auto& parameters = *result.mutable_parameters();
  AddParameter(parameters, "scatter_removed_share", figures.removed_share, 0, "1");
  AddParameter(parameters, "scatter_floor_median", figures.floor_median, 0, result.unit());
  AddParameter(parameters, "scatter_below_floor_share", figures.below_floor_share, 0, "1");
}

absl::StatusOr<bool> IsOfInstrumentAlone(const std::filesystem::path& file) {
  v1::ScatterResult result;
  EYEBOX_RETURN_IF_ERROR(ReadJson(file, result));
  return result.has_instrument();
}

absl::StatusOr<optics::KnownGlare> ReadKnownGlare(const std::filesystem::path& file) {
  v1::ScatterResult result;
  EYEBOX_RETURN_IF_ERROR(ReadJson(file, result));
  const bool apart = result.has_instrument();
  if (!apart && !result.has_kernel()) {
    return BadInput(file.string(), "holds no kernel", "give what eyebox scatter --json printed");
  }
  const v1::ScatterKernel& message = apart ? result.instrument() : result.kernel();
  const std::string where = absl::StrCat(file.string(), ", ", apart ? "instrument" : "kernel");
  optics::KnownGlare glare;
  EYEBOX_ASSIGN_OR_RETURN(glare.kernel.core,
                          ShapeOf(kCores, message.core(), absl::StrCat(where, ".core")));
  EYEBOX_ASSIGN_OR_RETURN(glare.kernel.tail,
                          ShapeOf(kTails, message.tail(), absl::StrCat(where, ".tail")));
  glare.kernel.core_radius_deg = message.core_radius_deg();
  glare.kernel.tail_share = message.tail_share();
  glare.kernel.tail_radius_deg = message.tail_radius_deg();
  glare.kernel.tail_exponent = message.tail_exponent();
  glare.kernel.pedestal_share = message.pedestal_share();
  glare.kernel.reach_deg = message.reach_deg();
  glare.relative_sigma = message.glare_relative_sigma();
  const absl::Status valid = glare.kernel.Validate();
  if (!valid.ok()) return absl::Status(valid.code(), absl::StrCat(where, ": ", valid.message()));
  if (glare.relative_sigma >= 0 && glare.relative_sigma < 1e6) return glare;
  return BadInput(absl::StrCat(where, ".glare_relative_sigma"),
                  absl::StrCat("is ", glare.relative_sigma), "give 0 or more");
}

}  // namespace eyebox::service
