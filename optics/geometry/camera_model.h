// Where a pixel looks, and which pixel sees a direction.
#ifndef EYEBOX_OPTICS_GEOMETRY_CAMERA_MODEL_H_
#define EYEBOX_OPTICS_GEOMETRY_CAMERA_MODEL_H_

#include <array>
#include <optional>

#include "absl/status/status.h"
#include "capture/base/geometry.h"
#include "capture/base/image.h"
#include "optics/geometry/field_angle.h"
#include "optics/geometry/pixel_point.h"

namespace eyebox::optics {

enum class LensModel {
  // Perspective with Brown-Conrady distortion: k1, k2, p1, p2, k3. For fields up to about 40 deg
  // off the axis.
  kPinhole,
  // Equidistant with Kannala-Brandt distortion: the image lies at
  // f (a + k1 a^3 + k2 a^5 + k3 a^7 + k4 a^9) from the principal point, a the angle off the axis.
  kEquidistant,
};

// Parameters and their order are those of OpenCV 4 (calib3d, and its namespace fisheye), so that
// calibrations can be exchanged. Columns run right, rows down; directions point up where rows fall.
struct CameraModel {
  LensModel lens = LensModel::kPinhole;
  ImageSize size;  // of the sensor
  double focal_length_x_px = 0;
  double focal_length_y_px = 0;
  double principal_x_px = 0;  // pixel centres are at whole numbers
  double principal_y_px = 0;
  std::array<double, 5> distortion = {};  // the fifth is unused by kEquidistant

  // Errors: InvalidArgument (names the field: no size, focal length not above 0, not finite).
  absl::Status Validate() const;

  // The pixel that sees `direction` (any length above 0). Nothing where the model has none: behind
  // a pinhole, or where its distortion folds back.
  std::optional<PixelPoint> PixelOf(const Direction& direction) const;
  std::optional<PixelPoint> PixelOf(const FieldAngle& angle) const;

  // Of length 1; PixelOf() leads back to within 1e-9 px. Nothing where no direction does.
  std::optional<Direction> DirectionOf(const PixelPoint& pixel) const;
  // Nothing also for directions 90 deg or more off the axis, which field angles do not reach.
  std::optional<FieldAngle> FieldAngleOf(const PixelPoint& pixel) const;
};

// Without distortion.
CameraModel IdealPinhole(const PinholeGeometry& geometry, ImageSize size);

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_GEOMETRY_CAMERA_MODEL_H_
