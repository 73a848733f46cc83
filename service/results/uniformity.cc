#include "service/results/uniformity.h"

#include <cmath>
#include <numbers>
#include <optional>

#include "capture/base/status.h"
#include "service/artifacts.h"
#include "service/results/contours.h"
#include "service/results/parameter.h"
#include "service/results/sigma_map.h"

namespace eyebox::service {
namespace {

// Beyond this, scatter of raw g about the smooth model is texture, not noise.
constexpr double kNotedResidualExcess = 1.5;
constexpr double kLevelsDiffer = 0.05;  // p-value

double FieldAngleDeg(double offset_px, const capture::PinholeGeometry& geometry) {
  return std::atan(offset_px / geometry.focal_length_px) * 180 / std::numbers::pi;
}

v1::UniformityPoint Describe(const optics::PatchRatio& patch,
                             const std::optional<capture::PinholeGeometry>& geometry) {
  v1::UniformityPoint point;
  point.set_x_px(patch.x_px);
  point.set_y_px(patch.y_px);
  point.set_g(patch.value);
  point.set_sigma(patch.sigma);
  if (geometry) {
    point.set_x_deg(FieldAngleDeg(patch.x_px - geometry->principal_x_px, *geometry));
    point.set_y_deg(FieldAngleDeg(geometry->principal_y_px - patch.y_px, *geometry));
  }
  return point;
}

void AddFigures(const optics::UniformityMap& map, v1::UniformityResult& result) {
  auto& parameters = *result.mutable_parameters();
  AddParameter(parameters, "uniformity_9_point", map.nine_points.uniformity, map.nine_points.sigma,
               "1");
  AddParameter(parameters, "nonuniformity_9_point", map.nine_points.nonuniformity,
               map.nine_points.sigma, "1");
  AddParameter(parameters, "uniformity_13_point", map.thirteen_points.uniformity,
               map.thirteen_points.sigma, "1");
  AddParameter(parameters, "nonuniformity_13_point", map.thirteen_points.nonuniformity,
               map.thirteen_points.sigma, "1");
  AddParameter(parameters, "g_minimum", map.area.g.minimum, map.area.minimum_sigma, "1");
  AddParameter(parameters, "g_maximum", map.area.g.maximum, map.area.maximum_sigma, "1");
  AddParameter(parameters, "uniformity_area", map.area.uniformity, map.area.uniformity_sigma, "1");
}

const char* NameOf(optics::FieldModel model, bool weighted) {
  if (model == optics::FieldModel::kSpline) return "spline";
  return weighted ? "weighted polynomial" : "polynomial";
}

v1::CrossValidatedModel Describe(const optics::CrossValidated& model, bool weighted) {
  v1::CrossValidatedModel line;
  line.set_model(NameOf(model.model, weighted));
  line.set_size(model.size);
  line.set_held_out_chi_square(model.held_out_chi2);
  return line;
}

void AddModels(const std::vector<optics::CrossValidated>& models, int best,
               std::optional<int> fitted, v1::UniformityDetail& detail) {
  for (const optics::CrossValidated& model : models) {
    v1::CrossValidatedModel& line = *detail.add_cross_validation();
    line = Describe(model, false);
    line.set_best(model.size == best);
    line.set_fitted(model.size == fitted);
  }
}

void AddDetail(const optics::UniformityMap& map, v1::UniformityDetail& detail) {
  std::optional<int> plain;
  if (!map.polynomial_weighted) plain = map.polynomial_order;
  AddModels(map.choice.polynomials, map.choice.polynomial.size, plain, detail);
  if (map.polynomial_weighted) {
    v1::CrossValidatedModel& weighted = *detail.add_cross_validation();
    weighted = Describe(map.choice.weighted, true);
    weighted.set_fitted(true);
  }
  AddModels(map.choice.splines, map.choice.spline.size, map.spline_intervals, detail);
  detail.set_smooth_model(NameOf(map.smooth.model, map.polynomial_weighted));
  detail.set_effective_functions(map.smooth.effective_functions);
  v1::FullFieldUniformity& field = *detail.mutable_full_field();
  field.set_minimum(map.area.g.minimum);
  field.set_minimum_sigma(map.area.minimum_sigma);
  field.set_maximum(map.area.g.maximum);
  field.set_maximum_sigma(map.area.maximum_sigma);
  field.set_mean(map.area.mean);
  field.set_deviation(map.area.deviation);
  field.set_uniformity(map.area.uniformity);
  field.set_uniformity_sigma(map.area.uniformity_sigma);
  const auto lines = ContourLines(map.smooth.Values(), ContourLevels(map.smooth_range));
  detail.mutable_contours()->Add(lines.begin(), lines.end());
}

absl::Status AddMaps(const optics::UniformityMap& map, const std::filesystem::path& folder,
                     v1::UniformityResult& result) {
  EYEBOX_ASSIGN_OR_RETURN(*result.add_maps(),
                          WriteMap(folder, "uniformity_g.npy", "g", "1", map.raw.value));
  EYEBOX_ASSIGN_OR_RETURN(*result.add_maps(), WriteMap(folder, "uniformity_g_sigma.npy", "g_sigma",
                                                       "1", SigmaMap(map.raw.variance)));
  if (!map.scatter_sigma.empty()) {
    EYEBOX_ASSIGN_OR_RETURN(*result.add_maps(),
                            WriteMap(folder, "uniformity_g_scatter_sigma.npy", "g_scatter_sigma",
                                     "1", map.scatter_sigma));
  }
  EYEBOX_ASSIGN_OR_RETURN(*result.add_maps(), WriteMap(folder, "uniformity_g_smooth.npy",
                                                       "g_smooth", "1", map.smooth.Values()));
  EYEBOX_ASSIGN_OR_RETURN(*result.add_maps(), WriteMap(folder, "uniformity_g_smooth_sigma.npy",
                                                       "g_smooth_sigma", "1", map.smooth.Sigmas()));
  if (!map.alternative) return absl::OkStatus();
  EYEBOX_ASSIGN_OR_RETURN(*result.add_maps(),
                          WriteMap(folder, "uniformity_g_alternative.npy", "g_alternative", "1",
                                   map.alternative->Values()));
  EYEBOX_ASSIGN_OR_RETURN(*result.add_maps(),
                          WriteMap(folder, "uniformity_g_alternative_sigma.npy",
                                   "g_alternative_sigma", "1", map.alternative->Sigmas()));
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<v1::UniformityResult> DescribeUniformity(
    const optics::UniformityMap& map, const optics::LuminanceImage& full_field,
    double reference_drive, const std::optional<capture::PinholeGeometry>& geometry,
    const std::filesystem::path& folder) {
  v1::UniformityResult result;
  AddFigures(map, result);
  result.set_reference_drive(reference_drive);
  v1::Parameter& reference = *result.mutable_reference_luminance();
  reference.set_name("reference_luminance");
  reference.set_value(map.reference_luminance);
  reference.set_sigma(std::hypot(map.reference_luminance_sigma,
                                 map.reference_luminance * full_field.scale_relative_sigma));
  reference.set_unit(full_field.image.unit);
  for (const optics::PatchRatio& patch : map.g_of_nine_points) {
    *result.add_points_9() = Describe(patch, geometry);
  }
  for (const optics::PatchRatio& patch : map.g_of_thirteen_points) {
    *result.add_points_13() = Describe(patch, geometry);
  }
  result.set_smooth_order(map.smooth.order);
  AddDetail(map, *result.mutable_detail());
  result.set_smooth_residual_rms(map.residual_rms);
  result.set_invalid_pixels(static_cast<int32_t>(optics::CountFlagged(map.raw, 0xFF)));
  AddAll(*result.mutable_history(), map.raw.history);
  if (map.residual_rms > kNotedResidualExcess * map.residual_rms_expected) {
    result.add_warnings(
        "raw g departs from the smooth model by more than its noise: use the raw "
        "map where texture matters");
  }
  if (!full_field.flat_corrected) {
    result.add_warnings("no flat was recorded: the camera's own vignetting is part of g");
  }
  EYEBOX_RETURN_IF_ERROR(AddMaps(map, folder, result));
  return result;
}

void AddScatterRemoval(const optics::GlareRemovalFigures& figures, v1::UniformityResult& result) {
  v1::ScatterRemoval& removal = *result.mutable_detail()->mutable_scatter();
  removal.set_removed_share(figures.removed_share);
  removal.set_floor_median(figures.floor_median);
  removal.set_below_floor_share(figures.below_floor_share);
}

absl::Status AddLevelIndependence(const absl::StatusOr<optics::LevelIndependence>& test,
                                  int block_px, const std::filesystem::path& folder,
                                  v1::UniformityResult& result) {
  v1::LevelIndependence& message = *result.mutable_detail()->mutable_level_independence();
  if (!test.ok()) {
    message.set_reason(std::string(test.status().message()));
    return absl::OkStatus();
  }
  message.set_chi_square(test->chi2);
  message.set_degrees_of_freedom(test->degrees_of_freedom);
  message.set_p_value(test->p_value);
  message.set_independent(test->p_value >= kLevelsDiffer);
  message.set_block_px(block_px);
  message.set_blocks(static_cast<int32_t>(test->blocks));
  message.set_failing_share(test->failing_share);
  for (const optics::LevelAgainstShared& level : test->levels) {
    v1::LevelOfIndependence& line = *message.add_levels();
    line.set_drive(level.drive);
    line.set_luminance(level.luminance);
    line.set_chi_square(level.chi2);
    line.set_excess_relative(level.excess_relative);
  }
  AddParameter(*result.mutable_parameters(), "level_independence_p_value", test->p_value, 0, "1");
  EYEBOX_ASSIGN_OR_RETURN(*result.add_maps(), WriteMap(folder, "uniformity_level_p_value.npy",
                                                       "level_p_value", "1", test->block_p_value));
  return absl::OkStatus();
}

}  // namespace eyebox::service
