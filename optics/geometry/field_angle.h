// Directions, and the two angles that name them in maps.
//
// A direction is (right, up, forward) as the camera sees it. Its field angles are
// horizontal = atan(right / forward) and vertical = atan(up / forward): both are measured from the
// axis, so a straight line in the world that is upright or level keeps one of them, and a pinhole's
// columns and rows are lines of constant angle. They are no longitude and latitude: away from the
// two middle lines the angle off the axis is atan(hypot(tan h, tan v)).
#ifndef EYEBOX_OPTICS_GEOMETRY_FIELD_ANGLE_H_
#define EYEBOX_OPTICS_GEOMETRY_FIELD_ANGLE_H_

#include <array>
#include <optional>

namespace eyebox::optics {

using Direction = std::array<double, 3>;  // right, up, forward
using Rotation = std::array<double, 9>;   // row-major, orthogonal

struct FieldAngle {
  double horizontal_deg = 0;  // right positive
  double vertical_deg = 0;    // up positive
};

// Of length 1, each component to 1e-15 of it. Both angles lie within (-90, 90) deg.
Direction DirectionOf(const FieldAngle& angle);
// To 1e-15 relative. Nothing for what does not point forward.
std::optional<FieldAngle> FieldAngleOf(const Direction& direction);

// Angle between `direction` and straight ahead, deg, to 1e-15 relative, near 0 too.
double AngleOffAxisDeg(const Direction& direction);

Direction Rotate(const Rotation& rotation, const Direction& direction);
// The inverse of a rotation.
Rotation Transposed(const Rotation& rotation);

// Solid angle of the region {left <= horizontal <= right, lower <= vertical <= upper}, sr: closed
// form of a rectangle on a plane seen from a point. To 1e-14 sr, so few digits are left of a region
// as small as a pixel: see PixelSolidAnglesSr() for those.
double SolidAngleSr(const FieldAngle& lower_left, const FieldAngle& upper_right);

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_GEOMETRY_FIELD_ANGLE_H_
