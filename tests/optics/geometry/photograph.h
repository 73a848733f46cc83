// Photographs of flat targets through a lens of known parameters.
#ifndef EYEBOX_TESTS_OPTICS_GEOMETRY_PHOTOGRAPH_H_
#define EYEBOX_TESTS_OPTICS_GEOMETRY_PHOTOGRAPH_H_

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "capture/base/image.h"
#include "optics/geometry/camera_model.h"
#include "optics/geometry/pose.h"

namespace eyebox::optics {

inline constexpr double kDegree = std::numbers::pi / 180;

// What the lens sees of a plane: for each of 2 x 2 places in a pixel the point of the target that
// the ray meets, where `brightness` says what is printed; light falls off towards the edge.
template <typename Brightness>
Image<double> Photograph(const CameraModel& lens, const Pose& pose, unsigned seed, double noise_dn,
                         Brightness brightness) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> noise(0, noise_dn);
  Image<double> view(lens.size);
  const Rotation back = Transposed(pose.rotation_camera_target);
  const Direction normal = Rotate(pose.rotation_camera_target, {0, 0, 1});
  const Direction& t = pose.translation_mm;
  for (int y = 0; y < lens.size.height_px; ++y) {
    for (int x = 0; x < lens.size.width_px; ++x) {
      double sum = 0;
      for (int part = 0; part < 4; ++part) {
        const auto ray = lens.DirectionOf({x + part % 2 * 0.5 - 0.25, y + part / 2 * 0.5 - 0.25});
        if (!ray) continue;
        const double along = (*ray)[0] * normal[0] + (*ray)[1] * normal[1] + (*ray)[2] * normal[2];
        const double away = t[0] * normal[0] + t[1] * normal[1] + t[2] * normal[2];
        const double length = away / along;
        if (!(length > 0)) continue;
        const Direction place = Rotate(back, {length * (*ray)[0] - t[0], length * (*ray)[1] - t[1],
                                              length * (*ray)[2] - t[2]});
        sum += (*ray)[2] * brightness(place[0], place[1]) / 4;
      }
      view.at(x, y) = std::max(0.0, 200 + 2000 * sum + noise(random));
    }
  }
  return view;
}

inline Pose At(double right, double up, double forward, double turn_x_deg, double turn_y_deg,
               double turn_z_deg) {
  return Moved({.translation_mm = {right, up, forward}},
               {turn_x_deg * kDegree, turn_y_deg * kDegree, turn_z_deg * kDegree}, {0, 0, 0});
}

inline std::vector<Pose> Poses(double distance_mm) {
  return {At(0, 0, distance_mm, 0, 0, 0),    At(2, 1, distance_mm, 25, 0, 3),
          At(-2, 0, distance_mm, -25, 5, 0), At(0, -2, distance_mm, 0, 25, -5),
          At(1, 2, distance_mm, 4, -25, 0),  At(-1, 1, distance_mm, 18, 18, 8)};
}

// 1 on disks of a grid about the target's middle (columns and rows odd), 0 between them.
inline double GridOfDots(int columns, int rows, double pitch_mm, double radius_mm, double x_mm,
                         double y_mm) {
  const double column = std::round(x_mm / pitch_mm);
  const double row = std::round(y_mm / pitch_mm);
  if (2 * std::abs(column) > columns || 2 * std::abs(row) > rows) return 0;
  return std::hypot(x_mm - column * pitch_mm, y_mm - row * pitch_mm) < radius_mm ? 1 : 0;
}

}  // namespace eyebox::optics

#endif  // EYEBOX_TESTS_OPTICS_GEOMETRY_PHOTOGRAPH_H_
