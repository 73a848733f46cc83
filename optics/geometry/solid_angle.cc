#include "optics/geometry/solid_angle.h"

#include <cmath>
#include <limits>
#include <vector>

#include "capture/base/status.h"

namespace eyebox::optics {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

double Dot(const Direction& a, const Direction& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

Direction Less(const Direction& a, const Direction& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

double Determinant(const Direction& a, const Direction& b, const Direction& c) {
  return a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
         a[2] * (b[0] * c[1] - b[1] * c[0]);
}

// Differences of corners keep the digits that the triple product of the corners would lose.
double TriangleSr(const Direction& a, const Direction& b, const Direction& c) {
  return 2 *
         std::atan2(Determinant(a, Less(b, a), Less(c, a)), 1 + Dot(a, b) + Dot(b, c) + Dot(c, a));
}

std::vector<Direction> CornerRow(const CameraModel& model, int y) {
  std::vector<Direction> corners;
  corners.reserve(static_cast<size_t>(model.size.width_px) + 1);
  for (int x = 0; x <= model.size.width_px; ++x) {
    corners.push_back(
        model.DirectionOf(PixelPoint{x - 0.5, y - 0.5}).value_or(Direction{kNaN, kNaN, kNaN}));
  }
  return corners;
}

}  // namespace

absl::StatusOr<Image<double>> PixelSolidAnglesSr(const CameraModel& model) {
  EYEBOX_RETURN_IF_ERROR(model.Validate());
  Image<double> solid_angle_sr(model.size);
  std::vector<Direction> above = CornerRow(model, 0);
  for (int y = 0; y < model.size.height_px; ++y) {
    std::vector<Direction> below = CornerRow(model, y + 1);
    for (int x = 0; x < model.size.width_px; ++x) {
      solid_angle_sr.at(x, y) = TriangleSr(above[x], below[x], below[x + 1]) +
                                TriangleSr(above[x], below[x + 1], above[x + 1]);
    }
    above.swap(below);
  }
  return solid_angle_sr;
}

}  // namespace eyebox::optics
