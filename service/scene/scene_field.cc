#include "service/scene/scene_field.h"

#include <cmath>

#include "absl/strings/str_cat.h"
#include "capture/base/status.h"

namespace eyebox::service {
namespace {

std::string Words(const Range& range) {
  if (!std::isfinite(range.least)) return "it must be finite";
  if (std::isfinite(range.most)) {
    return absl::StrCat("it must be ", range.above_least ? "above " : "from ", range.least,
                        " up to ", range.most);
  }
  return absl::StrCat("it must be ", range.above_least ? "above " : "at least ", range.least);
}

}  // namespace

SceneField SceneField::Entry(std::string_view list, int index, const std::string& name) const {
  return Of(
      absl::StrCat(std::string(list), "[", index, "]", name.empty() ? "" : " (" + name + ")"));
}

absl::Status SceneField::Refuse(std::string_view what, std::string_view remedy) const {
  return BadInput(where, what, remedy);
}

absl::StatusOr<double> SceneField::Number(double value, const Range& range) const {
  const bool inside = range.above_least ? value > range.least : value >= range.least;
  if (std::isfinite(value) && inside && value <= range.most) return value;
  return Refuse(absl::StrCat("is ", value), Words(range));
}

absl::StatusOr<optics::Rgb> SceneField::Color(const v1::SceneColor& color,
                                              const Range& range) const {
  optics::Rgb rgb;
  EYEBOX_ASSIGN_OR_RETURN(rgb[0], Of("r").Number(color.r(), range));
  EYEBOX_ASSIGN_OR_RETURN(rgb[1], Of("g").Number(color.g(), range));
  EYEBOX_ASSIGN_OR_RETURN(rgb[2], Of("b").Number(color.b(), range));
  return rgb;
}

absl::StatusOr<optics::Vec3> SceneField::Place(const v1::SceneVector& vector) const {
  optics::Vec3 place;
  EYEBOX_ASSIGN_OR_RETURN(place.x, Of("x").Number(vector.x(), kAnyFinite));
  EYEBOX_ASSIGN_OR_RETURN(place.y, Of("y").Number(vector.y(), kAnyFinite));
  EYEBOX_ASSIGN_OR_RETURN(place.z, Of("z").Number(vector.z(), kAnyFinite));
  return place;
}

absl::StatusOr<optics::Vec3> SceneField::Direction(const v1::SceneVector& vector) const {
  EYEBOX_ASSIGN_OR_RETURN(const optics::Vec3 direction, Place(vector));
  const double length = optics::Length(direction);
  if (!(length > 1e-150 && length < 1e150)) {
    return Refuse("points nowhere", "give x, y, z of a direction");
  }
  return optics::Normalised(direction);
}

}  // namespace eyebox::service
