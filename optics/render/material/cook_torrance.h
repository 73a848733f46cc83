// Cook-Torrance: Lambert plus a highlight of Beckmann facets in V-shaped cavities.
#ifndef EYEBOX_OPTICS_RENDER_MATERIAL_COOK_TORRANCE_H_
#define EYEBOX_OPTICS_RENDER_MATERIAL_COOK_TORRANCE_H_

#include <variant>

#include "optics/render/material/directions.h"
#include "optics/render/rgb.h"

namespace eyebox::optics {

struct DielectricFresnel {
  double index = 1.5;  // relative refractive index, above 0
};
struct SchlickFresnel {
  Rgb f0 = {0.04, 0.04, 0.04};
};
using Fresnel = std::variant<DielectricFresnel, SchlickFresnel>;

enum class HighlightScale {
  kPublished,   // F D G / (pi n.l n.v) with D = exp(-tan^2 / m^2) / (m^2 cos^4): Kyselka 2.4.1
  kNormalised,  // a quarter of it, for which facets reflect no more light than they receive
};

// f_r = diffuse / pi + F D G / (n.l n.v pi) (Kyselka section 2.4.1; Cook and Torrance 1982).
// Relative error below 1e-12 where it is above 1e-280.
struct CookTorrance {
  Rgb diffuse = {1, 1, 1};
  Fresnel fresnel = SchlickFresnel{};
  double roughness = 0.5;  // m, rms slope, above 0; not below kRoughnessFloor in computation
  HighlightScale scale = HighlightScale::kPublished;

  // As the Standard shader's: below it a highlight is a mirror image.
  static constexpr double kRoughnessFloor = 0.002;

  Rgb Reflected(const Directions& d) const;
  // Integral over the hemisphere, relative error below 1e-3.
  Rgb AmbientReflected(double n_v) const;

 private:
  Rgb Highlight(const Directions& d, double shadowed_density) const;
};

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_RENDER_MATERIAL_COOK_TORRANCE_H_
