#include "service/steps/known_geometry.h"

#include <cmath>
#include <string>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "capture/base/file.h"
#include "capture/base/status.h"
#include "eyebox/v1/geometry.pb.h"
#include "optics/geometry/resample.h"
#include "service/artifacts.h"
#include "service/result_json.h"
#include "service/results/geometry.h"
#include "service/results/parameter.h"
#include "service/results/sigma_map.h"

namespace eyebox::service {
namespace {

void GiveAngles(const optics::ViewGeometry& geometry,
                google::protobuf::RepeatedPtrField<v1::UniformityPoint>& points) {
  for (v1::UniformityPoint& point : points) {
    const auto angle = geometry.FieldAngleOf({point.x_px(), point.y_px()});
    point.clear_x_deg();
    point.clear_y_deg();
    if (!angle) continue;
    point.set_x_deg(angle->horizontal_deg);
    point.set_y_deg(angle->vertical_deg);
  }
}

double StepDeg(const optics::CameraModel& camera) {
  const double pixel_deg = 45 / std::atan(1.0) / camera.focal_length_x_px;
  double decade = std::pow(10, std::floor(std::log10(2 * pixel_deg)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * decade >= 2 * pixel_deg) return factor * decade;
  }
  return 10 * decade;
}

// What pixels share of scattered light is averaged as it is, their noise as noise.
absl::StatusOr<optics::FieldMap> ResampleG(const optics::UniformityMap& map,
                                           const optics::ViewGeometry& geometry,
                                           const optics::FieldGrid& grid) {
  if (map.scatter_sigma.empty()) return optics::ResampleToField(map.raw, geometry, grid);
  optics::MeasuredImage noise = map.raw;
  for (size_t i = 0; i < noise.variance.pixels().size(); ++i) {
    const float shared = map.scatter_sigma.pixels()[i];
    noise.variance.pixels()[i] -= shared * shared;
  }
  EYEBOX_ASSIGN_OR_RETURN(optics::FieldMap field, optics::ResampleToField(noise, geometry, grid));
  noise.value = map.scatter_sigma;
  EYEBOX_ASSIGN_OR_RETURN(const optics::FieldMap shared,
                          optics::ResampleToField(noise, geometry, grid));
  for (size_t i = 0; i < field.image.variance.pixels().size(); ++i) {
    const float sigma = shared.image.value.pixels()[i];
    field.image.variance.pixels()[i] += sigma * sigma;
  }
  return field;
}

}  // namespace

absl::StatusOr<std::optional<optics::ViewGeometry>> KnownGeometry(
    const std::filesystem::path& recording, const std::filesystem::path& asked) {
  std::filesystem::path file = asked;
  if (file.empty()) file = recording / kGeometryFile;
  if (asked.empty() && !std::filesystem::exists(file)) return std::nullopt;
  v1::GeometryResult result;
  EYEBOX_RETURN_IF_ERROR(ReadJson(file, result));
  EYEBOX_ASSIGN_OR_RETURN(const optics::ViewGeometry geometry, GeometryOf(result, file.string()));
  if (!result.accepted()) {
    return Rejected(file.string(),
                    absl::StrCat("was not accepted: ", absl::StrJoin(result.reasons(), "; ")),
                    "calibrate the camera again");
  }
  return geometry;
}

absl::Status KeepGeometry(const std::filesystem::path& file,
                          const std::filesystem::path& recording) {
  if (file.empty()) return absl::OkStatus();
  EYEBOX_RETURN_IF_ERROR(KnownGeometry(recording, file).status());
  EYEBOX_ASSIGN_OR_RETURN(const std::string content, ReadWholeFile(file));
  return WriteFileAtomically(recording / kGeometryFile, content);
}

absl::Status AddFieldMap(const std::optional<optics::ViewGeometry>& geometry,
                         const optics::UniformityMap& map, const std::filesystem::path& folder,
                         v1::UniformityResult& result) {
  if (!geometry) return absl::OkStatus();
  EYEBOX_ASSIGN_OR_RETURN(const optics::FieldGrid grid,
                          optics::GridOver(*geometry, StepDeg(geometry->camera)));
  EYEBOX_ASSIGN_OR_RETURN(optics::FieldMap field, ResampleG(map, *geometry, grid));
  GiveAngles(*geometry, *result.mutable_points_9());
  GiveAngles(*geometry, *result.mutable_points_13());
  auto& parameters = *result.mutable_parameters();
  AddParameter(parameters, "field_left_deg", grid.left_deg, 0, "deg");
  AddParameter(parameters, "field_top_deg", grid.top_deg, 0, "deg");
  AddParameter(parameters, "field_step_deg", grid.step_deg, 0, "deg");
  EYEBOX_ASSIGN_OR_RETURN(*result.add_maps(), WriteMap(folder, "uniformity_g_field.npy", "g_field",
                                                       "1", field.image.value));
  EYEBOX_ASSIGN_OR_RETURN(*result.add_maps(),
                          WriteMap(folder, "uniformity_g_field_sigma.npy", "g_field_sigma", "1",
                                   SigmaMap(field.image.variance)));
  AddAll(*result.mutable_history(), {field.image.history.back()});
  return absl::OkStatus();
}

}  // namespace eyebox::service
