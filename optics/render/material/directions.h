// The angles that reflection models need, from three unit vectors.
#ifndef EYEBOX_OPTICS_RENDER_MATERIAL_DIRECTIONS_H_
#define EYEBOX_OPTICS_RENDER_MATERIAL_DIRECTIONS_H_

#include "optics/render/material/vec3.h"

namespace eyebox::optics {

// n surface normal, l towards the light, v towards the eye, h half way between l and v, r the
// mirror image of l. All unit vectors.
struct Directions {
  double n_l = 0;
  double n_v = 0;
  double n_h = 1;
  double h_sin2 = 0;  // 1 - (n.h)^2 as |n x h|^2, so that sharp highlights keep their digits
  double l_h = 1;     // = v.h
  double v_r = 0;

  // Neither light nor eye is behind the surface, and the light is not in its plane either: only
  // then is anything reflected.
  bool InFront() const { return n_l > 0 && n_v >= 0; }
};

// Three unit vectors. Where l = -v, h does not exist; it is taken as n, the limit for light and eye
// that sink to the surface together. n_h to 1e-15, h_sin2 to 1e-15 of its root.
Directions DirectionsBetween(const Vec3& normal, const Vec3& light, const Vec3& view);

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_RENDER_MATERIAL_DIRECTIONS_H_
