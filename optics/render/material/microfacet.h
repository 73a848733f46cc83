// The factors of a microfacet highlight: how many facets face h (D), how many of them are seen and
// lit (G, here as the visibility V = G / (4 n.l n.v)), how much each reflects (F).
//
// Roughness is alpha, of the slopes (not Unity's perceptual roughness), and above 0. Relative
// errors below 1e-15 for the numbers in Directions as they stand, unless a comment says another
// figure.
#ifndef EYEBOX_OPTICS_RENDER_MATERIAL_MICROFACET_H_
#define EYEBOX_OPTICS_RENDER_MATERIAL_MICROFACET_H_

#include "optics/render/material/directions.h"
#include "optics/render/rgb.h"

namespace eyebox::optics {

// D of GGX (Kyselka section 3.2.2; Walter et al. 2007, eq 33), 1/sr: its integral over n.h is 1.
double GgxDistribution(const Directions& d, double roughness);

// D of Beckmann (Kyselka section 2.4.1) over pi, 1/sr: its integral over n.h is 1. 0 at n.h = 0.
// Relative error below 1e-12 where D is above 1e-290.
double BeckmannDistribution(const Directions& d, double roughness);

// V n.l of Smith's height-correlated masking and shadowing (Kyselka section 3.2.2; Heitz 2014, eq
// 99). Finite for every n.v >= 0; 0 where n.l <= 0.
double SmithVisibility(double n_l, double n_v, double roughness);

// V n.l as the Standard shader computes it: linear in place of the square roots, and 1e-5 in the
// denominator (UnityStandardBRDF.cginc, SmithJointGGXVisibilityTerm).
double SmithVisibilityApproximate(double n_l, double n_v, double roughness);

// V n.l of V-shaped cavities (Kyselka section 2.4.1; Cook and Torrance 1982). 0 where n.l <= 0.
// It grows without bound where light and eye sink to the horizon opposite each other: l.h counts as
// at least 1e-100 there.
double CavityVisibility(const Directions& d);

// F of unpolarised light at a dielectric of relative refractive index `index` > 0, at the cosine
// `u` of incidence (Kyselka section 2.4.1). 1 beyond the critical angle. Relative error below
// 1e-14.
double FresnelExact(double u, double index);

// Schlick's approximation, f0 + (1 - f0) (1 - u)^5 (Kyselka section 2.4.1).
double FresnelSchlick(double u, double f0);
Rgb FresnelSchlick(double u, const Rgb& f0);

// (1 - u)^5
double Schlick5(double u);

// Disney's diffuse factor, without colour / pi: (1 + (F90 - 1)(1 - n.l)^5)(1 + (F90 - 1)(1 -
// n.v)^5), F90 = 0.5 + 2 r (l.h)^2, r the perceptual roughness (Kyselka section 3.2.2).
double DisneyDiffuse(const Directions& d, double perceptual_roughness);

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_RENDER_MATERIAL_MICROFACET_H_
