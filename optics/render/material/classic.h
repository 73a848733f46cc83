// The empirical models: Lambert, Phong, Blinn-Phong. Colours are scene-linear reflectances.
//
// Every material answers two questions. Reflected(d): how much of the irradiance of a small source,
// taken perpendicular to its direction, leaves towards the eye: f_r n.l, in 1/sr, per channel.
// AmbientReflected(n_v): radiance towards the eye over that of a uniform surround.
// Both are finite for all directions; Reflected is 0 unless d.InFront().
#ifndef EYEBOX_OPTICS_RENDER_MATERIAL_CLASSIC_H_
#define EYEBOX_OPTICS_RENDER_MATERIAL_CLASSIC_H_

#include "optics/render/material/directions.h"
#include "optics/render/rgb.h"

namespace eyebox::optics {

// f_r = diffuse / pi (Kyselka section 2.3.1).
struct Lambert {
  Rgb diffuse = {1, 1, 1};

  Rgb Reflected(const Directions& d) const;
  Rgb AmbientReflected(double) const { return diffuse; }
};

// pi f_r n.l = diffuse n.l + specular (v.r)^exponent (Kyselka section 2.3.2: light of colour 1 is
// an irradiance of pi). The highlight is not weighted with n.l, so it is neither reciprocal nor
// bounded in energy. The surround meets the surface's colour alone, as published.
struct Phong {
  Rgb diffuse = {1, 1, 1};
  Rgb specular = {0, 0, 0};
  double exponent = 1;  // at least 1

  Rgb Reflected(const Directions& d) const;
  Rgb AmbientReflected(double) const { return diffuse; }
};

// The same with (n.h)^exponent (Kyselka section 2.3.3).
struct BlinnPhong {
  Rgb diffuse = {1, 1, 1};
  Rgb specular = {0, 0, 0};
  double exponent = 1;  // at least 1

  Rgb Reflected(const Directions& d) const;
  Rgb AmbientReflected(double) const { return diffuse; }
};

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_RENDER_MATERIAL_CLASSIC_H_
