// A place in an image.
#ifndef EYEBOX_OPTICS_GEOMETRY_PIXEL_POINT_H_
#define EYEBOX_OPTICS_GEOMETRY_PIXEL_POINT_H_

namespace eyebox::optics {

struct PixelPoint {
  double x_px = 0;  // pixel centres are at whole numbers
  double y_px = 0;
};

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_GEOMETRY_PIXEL_POINT_H_
