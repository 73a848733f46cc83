#include "optics/geometry/field_angle.h"

#include <cmath>
#include <numbers>

namespace eyebox::optics {
namespace {

constexpr double kDegPerRad = 180 / std::numbers::pi;

// Near 90 deg the conversion to radians would lose the distance to it, which degrees hold exactly.
double TanDeg(double angle_deg) {
  const double size = std::abs(angle_deg);
  const double tangent =
      size <= 45 ? std::tan(size / kDegPerRad) : 1 / std::tan((90 - size) / kDegPerRad);
  return std::copysign(tangent, angle_deg);
}

// Solid angle between the axis and the corner (h, v) of a rectangle: atan(x y / sqrt(1 + x^2 +
// y^2)) with x = tan h and y = tan v.
double QuadrantSr(double horizontal_deg, double vertical_deg) {
  const double x = TanDeg(horizontal_deg);
  const double y = TanDeg(vertical_deg);
  return std::atan(x * y / std::hypot(1, x, y));
}

}  // namespace

Direction DirectionOf(const FieldAngle& angle) {
  const double x = TanDeg(angle.horizontal_deg);
  const double y = TanDeg(angle.vertical_deg);
  const double length = std::hypot(x, y, 1);
  return {x / length, y / length, 1 / length};
}

std::optional<FieldAngle> FieldAngleOf(const Direction& direction) {
  const auto [right, up, forward] = direction;
  if (!(forward > 0)) return std::nullopt;
  return FieldAngle{std::atan2(right, forward) * kDegPerRad, std::atan2(up, forward) * kDegPerRad};
}

double AngleOffAxisDeg(const Direction& direction) {
  return std::atan2(std::hypot(direction[0], direction[1]), direction[2]) * kDegPerRad;
}

Direction Rotate(const Rotation& rotation, const Direction& direction) {
  Direction turned;
  for (size_t i = 0; i < 3; ++i) {
    turned[i] = rotation[3 * i] * direction[0] + rotation[3 * i + 1] * direction[1] +
                rotation[3 * i + 2] * direction[2];
  }
  return turned;
}

Rotation Transposed(const Rotation& rotation) {
  return {rotation[0], rotation[3], rotation[6], rotation[1], rotation[4],
          rotation[7], rotation[2], rotation[5], rotation[8]};
}

double SolidAngleSr(const FieldAngle& lower_left, const FieldAngle& upper_right) {
  return QuadrantSr(upper_right.horizontal_deg, upper_right.vertical_deg) -
         QuadrantSr(lower_left.horizontal_deg, upper_right.vertical_deg) -
         QuadrantSr(upper_right.horizontal_deg, lower_left.vertical_deg) +
         QuadrantSr(lower_left.horizontal_deg, lower_left.vertical_deg);
}

}  // namespace eyebox::optics
