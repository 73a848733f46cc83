// Reading numbers, colours and directions of a scene file, so that each complaint names its field.
#ifndef EYEBOX_SERVICE_SCENE_SCENE_FIELD_H_
#define EYEBOX_SERVICE_SCENE_SCENE_FIELD_H_

#include <limits>
#include <string>
#include <string_view>

#include "absl/status/statusor.h"
#include "eyebox/v1/scene.pb.h"
#include "optics/render/material/vec3.h"
#include "optics/render/rgb.h"

namespace eyebox::service {

struct Range {
  double least = 0;
  double most = std::numeric_limits<double>::infinity();
  bool above_least = false;  // `least` itself is out
};
constexpr Range kUnitRange = {0, 1};
constexpr Range kFromZero = {0};
constexpr Range kAboveZero = {.above_least = true};
constexpr Range kAnyFinite = {-std::numeric_limits<double>::infinity()};

// Where a field stands: "room.textproto materials[1] (wall) smoothness".
struct SceneField {
  std::string where;

  SceneField Of(std::string_view name) const { return {where + " " + std::string(name)}; }
  SceneField Entry(std::string_view list, int index, const std::string& name) const;

  absl::Status Refuse(std::string_view what, std::string_view remedy) const;
  // Errors: InvalidArgument naming the field (not finite, out of range, no length).
  absl::StatusOr<double> Number(double value, const Range& range) const;
  absl::StatusOr<optics::Rgb> Color(const v1::SceneColor& color, const Range& range) const;
  absl::StatusOr<optics::Vec3> Place(const v1::SceneVector& vector) const;
  absl::StatusOr<optics::Vec3> Direction(const v1::SceneVector& vector) const;
};

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_SCENE_SCENE_FIELD_H_
