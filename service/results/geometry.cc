#include "service/results/geometry.h"

#include <array>
#include <cmath>
#include <string>

#include "absl/strings/str_cat.h"
#include "capture/base/status.h"
#include "fit/base/conditioning.h"
#include "optics/geometry/solid_angle.h"
#include "service/results/parameter.h"

namespace eyebox::service {
namespace {

using optics::LensModel;

struct NamedParameter {
  const char* pinhole;
  const char* equidistant;
  const char* unit;
};

constexpr std::array<NamedParameter, 9> kParameters = {{
    {"focal_length_x_px", "focal_length_x_px", "px"},
    {"focal_length_y_px", "focal_length_y_px", "px"},
    {"principal_x_px", "principal_x_px", "px"},
    {"principal_y_px", "principal_y_px", "px"},
    {"k1", "k1", "1"},
    {"k2", "k2", "1"},
    {"p1", "k3", "1"},
    {"p2", "k4", "1"},
    {"k3", nullptr, "1"},
}};

const char* NameOf(LensModel lens, const NamedParameter& parameter) {
  return lens == LensModel::kPinhole ? parameter.pinhole : parameter.equidistant;
}

std::array<double*, 9> ValuesOf(optics::CameraModel& model) {
  return {&model.focal_length_x_px, &model.focal_length_y_px, &model.principal_x_px,
          &model.principal_y_px,    &model.distortion[0],     &model.distortion[1],
          &model.distortion[2],     &model.distortion[3],     &model.distortion[4]};
}

void AddParameters(const optics::LensCalibration& calibration, v1::GeometryResult& result) {
  optics::CameraModel model = calibration.model;
  const auto values = ValuesOf(model);
  for (size_t i = 0; i < kParameters.size(); ++i) {
    const char* name = NameOf(model.lens, kParameters[i]);
    if (name == nullptr) continue;
    AddParameter(*result.mutable_parameters(), name, *values[i], calibration.sigma[i],
                 kParameters[i].unit);
    for (size_t j = 0; j < kParameters.size(); ++j) {
      if (NameOf(model.lens, kParameters[j]) == nullptr) continue;
      result.add_covariance(calibration.covariance[i * kParameters.size() + j]);
    }
  }
  result.set_condition_number(fit::ConditionNumber(
      {result.covariance().data(), static_cast<size_t>(result.covariance_size())}));
}

// Field angles of the middles of the edges, and the solid angle of what is seen.
absl::Status AddField(const optics::CameraModel& model, const optics::EntrancePupil& pupil,
                      v1::GeometryResult& result) {
  EYEBOX_ASSIGN_OR_RETURN(const Image<double> pixels_sr, optics::PixelSolidAnglesSr(model));
  double sum_sr = 0;
  for (const double sr : pixels_sr.pixels()) sum_sr += std::isfinite(sr) ? sr : 0;
  result.set_solid_angle_sr(sum_sr);
  const optics::ViewGeometry geometry = {model, pupil};
  const double right = model.size.width_px - 0.5;
  const double bottom = model.size.height_px - 0.5;
  const auto add = [&](double x, double y, bool horizontal) {
    const auto angle = geometry.FieldAngleOf({x, y});
    result.add_field_deg(!angle ? std::nan("")
                                : (horizontal ? angle->horizontal_deg : angle->vertical_deg));
  };
  add(-0.5, (bottom - 0.5) / 2, true);
  add(right, (bottom - 0.5) / 2, true);
  add((right - 0.5) / 2, bottom, false);
  add((right - 0.5) / 2, -0.5, false);
  return absl::OkStatus();
}

void AddPupil(const optics::EntrancePupil& pupil, v1::EntrancePupil& proto) {
  proto.set_diameter_mm(pupil.diameter_mm);
  proto.set_right_mm(pupil.right_mm);
  proto.set_up_mm(pupil.up_mm);
  proto.set_forward_mm(pupil.forward_mm);
  proto.set_yaw_deg(pupil.yaw_deg);
  proto.set_pitch_deg(pupil.pitch_deg);
  proto.set_roll_deg(pupil.roll_deg);
}

}  // namespace

absl::StatusOr<v1::GeometryResult> DescribeGeometry(
    const optics::LensCalibration& calibration, const std::optional<optics::EntrancePupil>& pupil) {
  v1::GeometryResult result;
  const optics::CameraModel& model = calibration.model;
  result.set_model(model.lens == LensModel::kPinhole ? "pinhole" : "equidistant");
  result.set_width_px(model.size.width_px);
  result.set_height_px(model.size.height_px);
  AddParameters(calibration, result);
  result.set_reprojection_rms_px(calibration.rms_px);
  result.set_points(calibration.points);
  for (const optics::ViewResidual& residual : calibration.views) {
    v1::GeometryView& view = *result.add_views();
    view.set_source(residual.source);
    view.set_points(residual.points);
    view.set_reprojection_rms_px(residual.rms_px);
    view.set_tilt_deg(residual.tilt_deg);
  }
  if (pupil) AddPupil(*pupil, *result.mutable_pupil());
  result.set_accepted(calibration.accepted);
  AddAll(*result.mutable_reasons(), calibration.reasons);
  AddAll(*result.mutable_warnings(), calibration.warnings);
  EYEBOX_RETURN_IF_ERROR(AddField(model, pupil.value_or(optics::EntrancePupil{}), result));
  return result;
}

void AddRegistration(const optics::Registration& registration, int points,
                     v1::GeometryResult& result) {
  v1::DisplayRegistration& proto = *result.mutable_registration();
  const optics::DisplayMap& map = registration.map;
  proto.set_order(map.order);
  proto.set_centre_x_px(map.centre.x_px);
  proto.set_centre_y_px(map.centre.y_px);
  proto.set_scale_px(map.scale_px);
  proto.mutable_horizontal_deg()->Add(map.horizontal_deg.begin(), map.horizontal_deg.end());
  proto.mutable_vertical_deg()->Add(map.vertical_deg.begin(), map.vertical_deg.end());
  proto.set_residual_rms_deg(registration.residual_rms_deg);
  proto.set_points(points);
  for (const optics::RegistrationOrder& tried : registration.orders) {
    v1::RegistrationOrder& order = *proto.add_orders();
    order.set_order(tried.order);
    order.set_cross_validation_rms_deg(tried.cross_validation_rms_deg);
  }
}

absl::StatusOr<optics::ViewGeometry> GeometryOf(const v1::GeometryResult& result,
                                                std::string_view where) {
  optics::ViewGeometry geometry;
  if (result.model() != "pinhole" && result.model() != "equidistant") {
    return BadInput(where, absl::StrCat("model '", result.model(), "'"),
                    "give what eyebox geometry wrote: a pinhole or an equidistant lens");
  }
  optics::CameraModel& model = geometry.camera;
  model.lens = result.model() == "pinhole" ? LensModel::kPinhole : LensModel::kEquidistant;
  model.size = {result.width_px(), result.height_px()};
  const auto values = ValuesOf(model);
  for (size_t i = 0; i < kParameters.size(); ++i) {
    const char* name = NameOf(model.lens, kParameters[i]);
    if (name == nullptr) continue;
    bool found = false;
    for (const v1::Parameter& parameter : result.parameters()) {
      if (parameter.name() != name) continue;
      *values[i] = parameter.value();
      found = true;
    }
    if (!found) {
      return BadInput(where, absl::StrCat("has no parameter ", name),
                      "give what eyebox geometry wrote");
    }
  }
  if (auto status = model.Validate(); !status.ok()) {
    return BadInput(where, std::string(status.message()), "calibrate again");
  }
  const v1::EntrancePupil& pupil = result.pupil();
  geometry.pupil = {pupil.diameter_mm(), pupil.right_mm(),  pupil.up_mm(),   pupil.forward_mm(),
                    pupil.yaw_deg(),     pupil.pitch_deg(), pupil.roll_deg()};
  if (auto status = geometry.pupil.Validate(); !status.ok()) {
    return BadInput(where, std::string(status.message()), "give the pupil again");
  }
  return geometry;
}

}  // namespace eyebox::service
