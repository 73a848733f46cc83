#include "service/results/report_input.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_replace.h"
#include "capture/base/version.h"
#include "service/results/activation.h"
#include "service/results/contours.h"

namespace eyebox::service {
namespace {

constexpr int kCurvePoints = 257;
constexpr int kErrorPoints = 600;
constexpr double kErrorCurveFrom = 0.01;  // as a fraction of white

const v1::Parameter& Named(const google::protobuf::RepeatedPtrField<v1::Parameter>& parameters,
                           std::string_view name) {
  const auto found = std::find_if(parameters.begin(), parameters.end(),
                                  [name](const auto& p) { return p.name() == name; });
  return found == parameters.end() ? v1::Parameter::default_instance() : *found;
}

std::string WithUnit(const v1::Parameter& parameter) {
  const std::string text = report::WithSigma(parameter.value(), parameter.sigma());
  return parameter.unit() == "1" ? text : absl::StrCat(text, " ", parameter.unit());
}

std::string RelativeSigma(const v1::Parameter& parameter) {
  if (!(parameter.value() > 0)) return "";
  return absl::StrCat("sigma ", report::Percent(parameter.sigma() / parameter.value()));
}

void AddKeyResults(const v1::RunResult& result, report::ReportInput& input) {
  const v1::Parameter& gamma = Named(result.parameters(), "gamma");
  const v1::Parameter& white = Named(result.parameters(), "maximum_luminance");
  const v1::Parameter& black = Named(result.parameters(), "minimum_luminance");
  const v1::Parameter& uniformity = Named(result.uniformity().parameters(), "uniformity_9_point");
  input.key_results = {{"gamma", WithUnit(gamma), RelativeSigma(gamma)},
                       {"luminance at white", WithUnit(white), RelativeSigma(white)},
                       {"luminance at black", WithUnit(black), RelativeSigma(black)},
                       {"uniformity, 9 points", WithUnit(uniformity), "min / max"}};
  for (const v1::CubeResult& cube : result.cubes()) {
    input.key_results.push_back(
        {absl::StrCat("worst error, ", cube.target(), " ", cube.size()),
         report::Percent(cube.certificate().max_relative()),
         absl::StrCat("rms ", report::Percent(cube.certificate().rms_relative()))});
  }
}

std::string_view NameOf(capture::RecordingOrigin origin) {
  switch (origin) {
    case capture::RecordingOrigin::kCaptured:
      return "captured from a device";
    case capture::RecordingOrigin::kSimulated:
      return "simulated: no display was measured";
    case capture::RecordingOrigin::kImported:
      return "frames imported from other software";
  }
  return "";
}

std::string CameraOf(const capture::CameraInfo& camera) {
  std::string text;
  for (const std::string& part : {camera.vendor, camera.model, camera.serial}) {
    if (!part.empty()) absl::StrAppend(&text, text.empty() ? "" : " ", part);
  }
  return text.empty() ? "not stated" : text;
}

void AddFacts(const RunFindings& findings, report::ReportInput& input) {
  const capture::CameraInfo& camera = findings.header.camera;
  const v1::RunResult& result = findings.result;
  std::string exposures;
  int frames = 0;
  for (const v1::ExposureShare& exposure : result.reduction().exposures()) {
    absl::StrAppend(&exposures, exposures.empty() ? "" : ", ",
                    absl::StrFormat("%g s", exposure.exposure_s()));
    frames = std::max(frames, exposure.frames());
  }
  input.facts = {
      {"Origin", std::string(NameOf(findings.header.origin))},
      {"Camera", CameraOf(camera)},
      {"Sensor", absl::StrFormat("%d × %d pixels, %d bits", camera.sensor_size.width_px,
                                 camera.sensor_size.height_px, camera.significant_bits)},
      {"Gain", WithUnit(Named(result.reduction().parameters(), "system_gain"))},
      {"Noise model", result.reduction().noise_source()},
      {"Levels", absl::StrCat(result.activation().levels_size(), " grey levels, full field")},
      {"Exposures", absl::StrCat(exposures, "; ", frames, " frames each")},
      {"Luminance scale",
       absl::StrCat("relative sigma ", report::Percent(result.activation().scale_relative_sigma()),
                    ", common to all luminances")},
      {"Reduced with", "Eyebox " + std::string(kVersion)}};
}

// Field angles of pixels 0 ... count - 1 along one axis.
std::vector<double> AnglesDeg(int count, double principal_px, double focal_length_px, int sign) {
  std::vector<double> angles;
  for (int i = 0; i < count; ++i) {
    angles.push_back(sign * std::atan((i - principal_px) / focal_length_px) * 180 /
                     std::numbers::pi);
  }
  return angles;
}

std::string NameOfSmooth(const optics::UniformityMap& map) {
  const optics::SmoothField& smooth = map.smooth;
  if (smooth.model == optics::FieldModel::kSpline) {
    return absl::StrFormat("bicubic spline of %d intervals", smooth.order);
  }
  if (!map.polynomial_weighted) return absl::StrFormat("polynomial of order %d", smooth.order);
  return absl::StrFormat("polynomial of weighted orders to %d (%.3g effective functions)",
                         smooth.order, smooth.effective_functions);
}

// The same of a calibrated camera, along the middle row and the middle column; empty where a pixel
// has no field angle.
void GiveAngles(const optics::ViewGeometry& geometry, report::MapFigure& figure) {
  const double middle_x = (figure.size.width_px - 1) / 2.0;
  const double middle_y = (figure.size.height_px - 1) / 2.0;
  std::vector<double> columns;
  std::vector<double> rows;
  for (int x = 0; x < figure.size.width_px; ++x) {
    const auto angle = geometry.FieldAngleOf({1.0 * x, middle_y});
    if (!angle) return;
    columns.push_back(angle->horizontal_deg);
  }
  for (int y = 0; y < figure.size.height_px; ++y) {
    const auto angle = geometry.FieldAngleOf({middle_x, 1.0 * y});
    if (!angle) return;
    rows.push_back(angle->vertical_deg);
  }
  figure.column_deg = std::move(columns);
  figure.row_deg = std::move(rows);
}

report::MapFigure MapOf(const RunFindings& findings) {
  const optics::UniformityMap& map = findings.map;
  report::MapFigure figure;
  figure.title = "Nonuniformity g(x) of the full field";
  figure.caption = absl::StrFormat(
      "Luminance over that at the reference point, at drive %.4g. Lines: smooth model, a %s; "
      "raw g scatters about it by %s rms, of which noise explains %s.",
      findings.result.uniformity().reference_drive(), NameOfSmooth(map),
      report::Percent(map.residual_rms), report::Percent(map.residual_rms_expected));
  figure.quantity = "g";
  figure.unit = "1";
  figure.size = map.raw.size();
  figure.values = map.raw.value.pixels();
  if (map.smooth_range.minimum < map.smooth_range.maximum) {
    figure.range = report::Range{map.smooth_range.minimum, map.smooth_range.maximum};
  }
  figure.contours = ContourLevels(map.smooth_range);
  figure.contoured = findings.smooth_g.pixels();
  if (findings.geometry) {
    GiveAngles(*findings.geometry, figure);
  } else if (const auto& geometry = findings.header.geometry) {
    figure.column_deg =
        AnglesDeg(figure.size.width_px, geometry->principal_x_px, geometry->focal_length_px, 1);
    figure.row_deg =
        AnglesDeg(figure.size.height_px, geometry->principal_y_px, geometry->focal_length_px, -1);
  }
  return figure;
}

report::FitFigure FitOf(const RunFindings& findings) {
  const v1::ActivationResult& activation = findings.result.activation();
  report::FitFigure figure;
  figure.title = "Activation at the reference point";
  figure.caption = absl::StrFormat(
      "L = L0 + L1 max((v - v0) / (1 - v0), 0)^gamma, %s, weights: %s. rms %s; left out and "
      "predicted without itself, a level is missed by %s rms. %s.",
      absl::StrReplaceAll(activation.model(), {{"_", " "}}),
      absl::StrReplaceAll(activation.weighting(), {{"_", " "}}),
      report::Percent(activation.rms_relative()),
      report::Percent(activation.leave_one_out_rms_relative()), activation.choice_reason());
  figure.luminance_unit = activation.luminance_unit();
  for (const v1::LevelResidual& level : activation.levels()) {
    figure.levels.push_back(
        {level.drive(), level.luminance(), level.luminance_sigma(), level.relative_residual()});
  }
  for (int i = 0; i < kCurvePoints; ++i) {
    const double drive = static_cast<double>(i) / (kCurvePoints - 1);
    figure.curve.push_back({drive, findings.activation.Luminance(drive)});
  }
  return figure;
}

void AddTables(const RunFindings& findings, report::ReportInput& input) {
  for (size_t i = 0; i < findings.tables.size(); ++i) {
    const v1::CubeResult& cube = findings.result.cubes(static_cast<int>(i));
    const v1::Certificate& certificate = cube.certificate();
    const std::string target = absl::StrCat(cube.target(), ", ", cube.size(), " knots");
    input.certificates.push_back({cube.file(),
                                  target,
                                  certificate.max_relative(),
                                  certificate.rms_relative(),
                                  certificate.at_u(),
                                  {certificate.u_from(), certificate.u_to()}});
    report::ErrorCurve curve{target, {}};
    for (const fit::ErrorPoint& point :
         fit::ErrorCurve(findings.tables[i], findings.activation, kErrorCurveFrom, kErrorPoints)) {
      curve.points.push_back({point.u, point.relative_error});
    }
    input.error_curves.push_back(std::move(curve));
  }
}

void AddParameters(std::string_view title,
                   const google::protobuf::RepeatedPtrField<v1::Parameter>& parameters,
                   report::ReportInput& input) {
  report::ParameterTable table{std::string(title), {}};
  for (const v1::Parameter& parameter : parameters) {
    table.rows.push_back(
        {parameter.name(), parameter.value(), parameter.sigma(), parameter.unit(), false});
  }
  input.parameters.push_back(std::move(table));
}

}  // namespace

report::ReportInput MakeReportInput(const RunFindings& findings) {
  const v1::RunResult& result = findings.result;
  report::ReportInput input;
  input.title = absl::StrCat("What the display shows: ", CameraOf(findings.header.camera));
  input.summary =
      "Recorded frames reduced to luminance, the field's nonuniformity mapped, its activation "
      "fitted, and lookup tables designed and certified from that fit.";
  AddKeyResults(result, input);
  AddFacts(findings, input);
  input.warnings.assign(result.warnings().begin(), result.warnings().end());
  input.maps.push_back(MapOf(findings));
  input.fit = FitOf(findings);
  AddTables(findings, input);
  AddParameters("Activation at the reference point", result.activation().parameters(), input);
  for (report::ParameterRow& row : input.parameters.back().rows) row.held = !(row.sigma > 0);
  AddParameters("One exponent for the whole field", result.activation().field().parameters(),
                input);
  AddParameters("Uniformity", result.uniformity().parameters(), input);
  AddParameters("Reduction of the reference level", result.reduction().parameters(), input);
  input.history.assign(result.uniformity().history().begin(), result.uniformity().history().end());
  return input;
}

}  // namespace eyebox::service
