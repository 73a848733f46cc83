// Where a pixel looks.
#ifndef EYEBOX_CAPTURE_BASE_GEOMETRY_H_
#define EYEBOX_CAPTURE_BASE_GEOMETRY_H_

namespace eyebox {

// Ideal pinhole: field angle = atan((pixel - principal point) / focal length).
struct PinholeGeometry {
  double focal_length_px = 0;
  double principal_x_px = 0;  // pixel centres are at whole numbers
  double principal_y_px = 0;
  friend bool operator==(const PinholeGeometry&, const PinholeGeometry&) = default;
};

}  // namespace eyebox

#endif  // EYEBOX_CAPTURE_BASE_GEOMETRY_H_
