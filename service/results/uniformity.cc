#include "service/results/uniformity.h"

#include <cmath>
#include <numbers>

#include "capture/base/status.h"
#include "service/artifacts.h"
#include "service/results/parameter.h"
#include "service/results/sigma_map.h"

namespace eyebox::service {
namespace {

// Beyond this, scatter of raw g about the smooth model is texture, not noise.
constexpr double kNotedResidualExcess = 1.5;

double FieldAngleDeg(double offset_px, const capture::PinholeGeometry& geometry) {
  return std::atan(offset_px / geometry.focal_length_px) * 180 / std::numbers::pi;
}

v1::UniformityPoint Describe(const optics::PatchMean& patch,
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

// Smallest and largest g of the smooth model over the valid pixels.
void AddExtremes(const optics::UniformityMap& map,
                 google::protobuf::RepeatedPtrField<v1::Parameter>& parameters) {
  const Image<float> values = map.smooth.Values();
  const Image<float> sigmas = map.smooth.Sigmas();
  std::optional<size_t> lowest;
  std::optional<size_t> highest;
  for (size_t i = 0; i < values.pixels().size(); ++i) {
    if (map.raw.mask.pixels()[i] != 0) continue;
    const float g = values.pixels()[i];
    if (!lowest || g < values.pixels()[*lowest]) lowest = i;
    if (!highest || g > values.pixels()[*highest]) highest = i;
  }
  if (!lowest) return;
  AddParameter(parameters, "g_minimum", values.pixels()[*lowest], sigmas.pixels()[*lowest], "1");
  AddParameter(parameters, "g_maximum", values.pixels()[*highest], sigmas.pixels()[*highest], "1");
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
  AddExtremes(map, parameters);
}

absl::Status AddMaps(const optics::UniformityMap& map, const std::filesystem::path& folder,
                     v1::UniformityResult& result) {
  EYEBOX_ASSIGN_OR_RETURN(*result.add_maps(),
                          WriteMap(folder, "uniformity_g.npy", "g", "1", map.raw.value));
  EYEBOX_ASSIGN_OR_RETURN(*result.add_maps(), WriteMap(folder, "uniformity_g_sigma.npy", "g_sigma",
                                                       "1", SigmaMap(map.raw.variance)));
  EYEBOX_ASSIGN_OR_RETURN(*result.add_maps(), WriteMap(folder, "uniformity_g_smooth.npy",
                                                       "g_smooth", "1", map.smooth.Values()));
  EYEBOX_ASSIGN_OR_RETURN(*result.add_maps(), WriteMap(folder, "uniformity_g_smooth_sigma.npy",
                                                       "g_smooth_sigma", "1", map.smooth.Sigmas()));
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
  for (const auto& patch : map.nine_points.patches) {
    *result.add_points_9() = Describe(patch, geometry);
  }
  for (const auto& patch : map.thirteen_points.patches) {
    *result.add_points_13() = Describe(patch, geometry);
  }
  result.set_smooth_order(map.smooth.order);
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

}  // namespace eyebox::service
