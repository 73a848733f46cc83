#include "optics/geometry/camera_model.h"

#include <cmath>

#include "absl/strings/str_cat.h"
#include "capture/base/status.h"
#include "optics/geometry/lens.h"

namespace eyebox::optics {

absl::Status CameraModel::Validate() const {
  if (size.width_px < 1 || size.height_px < 1) {
    return BadInput("camera model", absl::StrCat("size ", size.width_px, " x ", size.height_px),
                    "give the size of the sensor in pixels");
  }
  if (!(focal_length_x_px > 0 && focal_length_y_px > 0) || !std::isfinite(focal_length_x_px) ||
      !std::isfinite(focal_length_y_px)) {
    return BadInput(
        "camera model",
        absl::StrCat("focal lengths ", focal_length_x_px, ", ", focal_length_y_px, " px"),
        "give focal lengths above 0");
  }
  bool finite = std::isfinite(principal_x_px) && std::isfinite(principal_y_px);
  for (const double term : distortion) finite = finite && std::isfinite(term);
  if (!finite) {
    return BadInput("camera model", "principal point or distortion is not a finite number",
                    "calibrate again");
  }
  return absl::OkStatus();
}

std::optional<PixelPoint> CameraModel::PixelOf(const Direction& direction) const {
  const auto projection = Project(*this, direction);
  if (!projection) return std::nullopt;
  return projection->pixel;
}

std::optional<PixelPoint> CameraModel::PixelOf(const FieldAngle& angle) const {
  return PixelOf(optics::DirectionOf(angle));
}

std::optional<Direction> CameraModel::DirectionOf(const PixelPoint& pixel) const {
  return BackProject(*this, pixel);
}

std::optional<FieldAngle> CameraModel::FieldAngleOf(const PixelPoint& pixel) const {
  const auto direction = DirectionOf(pixel);
  if (!direction) return std::nullopt;
  return optics::FieldAngleOf(*direction);
}

CameraModel IdealPinhole(const PinholeGeometry& geometry, ImageSize size) {
  return {.lens = LensModel::kPinhole,
          .size = size,
          .focal_length_x_px = geometry.focal_length_px,
          .focal_length_y_px = geometry.focal_length_px,
          .principal_x_px = geometry.principal_x_px,
          .principal_y_px = geometry.principal_y_px};
}

}  // namespace eyebox::optics
