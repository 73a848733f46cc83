// The two lens models as functions of a point before the camera, with their derivatives.
#ifndef EYEBOX_OPTICS_GEOMETRY_LENS_H_
#define EYEBOX_OPTICS_GEOMETRY_LENS_H_

#include <array>
#include <optional>

#include "optics/geometry/camera_model.h"
#include "optics/geometry/field_angle.h"
#include "optics/geometry/pixel_point.h"

namespace eyebox::optics {

// fx, fy, cx, cy, then the distortion.
inline constexpr int kLensParameters = 9;

struct Projection {
  PixelPoint pixel;
  // d(x, y) / d(right, up, forward) and / d(parameters), row-major, 2 rows.
  std::array<double, 6> by_point = {};
  std::array<double, 2 * kLensParameters> by_parameter = {};
};

// `point` is (right, up, forward) in any unit. Nothing where the model has no image of it: behind a
// pinhole, at the pupil itself, or where the distortion folds back.
std::optional<Projection> Project(const CameraModel& model, const Direction& point);

// The model's distortion undone: of length 1. See CameraModel::DirectionOf().
std::optional<Direction> BackProject(const CameraModel& model, const PixelPoint& pixel);

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_GEOMETRY_LENS_H_
