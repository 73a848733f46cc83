#include "optics/render/material/directions.h"

#include <algorithm>

namespace eyebox::optics {

Directions DirectionsBetween(const Vec3& normal, const Vec3& light, const Vec3& view) {
  Directions d;
  d.n_l = Dot(normal, light);
  d.n_v = Dot(normal, view);
  d.v_r = 2 * d.n_l * d.n_v - Dot(light, view);
  const Vec3 sum = light + view;
  const double length = Length(sum);
  d.l_h = std::min(length / 2, 1.0);
  if (length == 0) return d;
  const Vec3 half = (1 / length) * sum;
  const Vec3 cross = Cross(normal, half);
  d.n_h = std::clamp(Dot(normal, half), 0.0, 1.0);
  d.h_sin2 = std::min(Dot(cross, cross), 1.0);
  return d;
}

}  // namespace eyebox::optics
