// What a material does with light from all over the hemisphere, measured from outside: it knows
// nothing but Reflected() of two directions.
#ifndef EYEBOX_TESTS_OPTICS_RENDER_MATERIAL_HEMISPHERE_H_
#define EYEBOX_TESTS_OPTICS_RENDER_MATERIAL_HEMISPHERE_H_

#include <algorithm>
#include <cmath>
#include <numbers>

#include "optics/render/material/material.h"
#include "optics/render/material/rgb_sum.h"

namespace eyebox::optics {

constexpr Vec3 kUp = {0, 1, 0};

// At `elevation_cosine` from the normal (0, 1, 0).
inline Vec3 DirectionAt(double elevation_cosine, double azimuth) {
  const double sine = std::sqrt(std::max(0.0, 1 - elevation_cosine * elevation_cosine));
  return {sine * std::cos(azimuth), elevation_cosine, sine * std::sin(azimuth)};
}

inline Rgb Reflected(const LitMaterial& material, const Vec3& light, const Vec3& view) {
  const Directions d = DirectionsBetween(kUp, light, view);
  return std::visit([&](const auto& m) { return m.Reflected(d); }, material);
}

// Directional albedo: the share of a small light's energy that comes back, summed over all ways
// out, for light from `n_l`. By midpoints over half vectors that crowd near the normal; with the
// default grid the error is below 1e-6 for lobes about as wide as `sharpness`.
struct AlbedoGrid {
  int tilts = 1500;
  int azimuths = 256;
  double sharpness = 0.3;  // tangent of the tilt that half the nodes lie within
};
// `reflected` of Directions.
template <typename Reflected>
double DirectionalAlbedo(Reflected reflected, double n_l, const AlbedoGrid& grid) {
  const Vec3 light = DirectionAt(n_l, 0);
  double sum = 0;
  for (int i = 0; i < grid.tilts; ++i) {
    const double s = (i + 0.5) / grid.tilts;
    const double tangent = grid.sharpness * s / (1 - s);
    const double cosine = 1 / std::sqrt(1 + tangent * tangent);
    const double d_tilt = grid.sharpness / ((1 - s) * (1 - s)) * cosine * cosine / grid.tilts;
    for (int k = 0; k < grid.azimuths; ++k) {
      const Vec3 half = DirectionAt(cosine, std::numbers::pi * (k + 0.5) / grid.azimuths);
      const double l_h = Dot(light, half);
      const Vec3 view = 2 * l_h * half - light;
      if (l_h <= 0 || view.y <= 0 || n_l <= 0) continue;
      const double solid_angle =
          4 * l_h * tangent * cosine * d_tilt * 2 * std::numbers::pi / grid.azimuths;
      // Of the irradiance n.l, f_r n.l n.v leaves per solid angle.
      sum += solid_angle * view.y / n_l * reflected(DirectionsBetween(kUp, light, view))[0];
    }
  }
  return sum;
}
inline double DirectionalAlbedo(const LitMaterial& material, double n_l, const AlbedoGrid& grid) {
  return std::visit(
      [&](const auto& m) {
        return DirectionalAlbedo([&](const Directions& d) { return m.Reflected(d); }, n_l, grid);
      },
      material);
}

// |f_r(l, v) - f_r(v, l)| over the larger one, from f_r n.l n.v both ways round. Light too faint
// for a double to hold all its digits counts as none.
inline double ReciprocityError(const LitMaterial& material, const Vec3& light, const Vec3& view) {
  const Rgb there = view.y * Reflected(material, light, view);
  const Rgb back = light.y * Reflected(material, view, light);
  double error = 0;
  for (int k = 0; k < 3; ++k) {
    const double larger = std::max(there[k], back[k]);
    if (larger > 1e-290) error = std::max(error, std::abs(there[k] - back[k]) / larger);
  }
  return error;
}

}  // namespace eyebox::optics

#endif  // EYEBOX_TESTS_OPTICS_RENDER_MATERIAL_HEMISPHERE_H_
