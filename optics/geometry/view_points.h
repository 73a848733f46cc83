// Points of a target as they were found in one view.
#ifndef EYEBOX_OPTICS_GEOMETRY_VIEW_POINTS_H_
#define EYEBOX_OPTICS_GEOMETRY_VIEW_POINTS_H_

#include <string>
#include <vector>

#include "optics/geometry/pixel_point.h"

namespace eyebox::optics {

struct TargetPoint {
  double x_mm = 0;  // in the plane of the target, right
  double y_mm = 0;  // down
  PixelPoint pixel;
};

struct ViewPoints {
  std::string source;  // file or capture, for messages
  std::vector<TargetPoint> points;
};

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_GEOMETRY_VIEW_POINTS_H_
