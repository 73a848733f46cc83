// Light that facets reflect towards an eye out of a uniform surround.
#ifndef EYEBOX_OPTICS_RENDER_MATERIAL_FACET_INTEGRAL_H_
#define EYEBOX_OPTICS_RENDER_MATERIAL_FACET_INTEGRAL_H_

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "optics/render/material/directions.h"

namespace eyebox::optics {

// Nodes and weights of a 64-point Gauss-Legendre rule on [0, 1].
struct UnitNode {
  double x = 0;
  double weight = 0;
};
const std::array<UnitNode, 64>& UnitNodes();

// Integral over light directions of D V n.l term(d) 1 sr, as an integral over half vectors that
// takes D out exactly: D n.h dh is a probability, whose `tan2_of(x)` is the squared tangent of the
// facet's tilt at the share x of facets that are flatter. `visibility(d)` is V n.l.
// Shape: adds to `sum`, which term(d, factor) is given to fill.
template <typename Tan2, typename Visibility, typename Term>
void IntegrateFacets(double n_v, Tan2 tan2_of, Visibility visibility, Term term) {
  constexpr int kAzimuths = 48;
  const double v_sin = std::sqrt(std::max(0.0, 1 - n_v * n_v));
  for (const UnitNode& node : UnitNodes()) {
    // Nodes crowd towards the steep facets, where the light sinks below the surface.
    const double share = 1 - (1 - node.x) * (1 - node.x);
    const double share_weight = node.weight * 2 * (1 - node.x);
    const double tan2 = tan2_of(share);
    const double n_h = 1 / std::sqrt(1 + tan2);
    const double h_sin = std::sqrt(tan2) * n_h;
    for (int k = 0; k < kAzimuths; ++k) {
      const double azimuth = std::numbers::pi * (k + 0.5) / kAzimuths;
      const double v_h = n_v * n_h + v_sin * h_sin * std::cos(azimuth);
      Directions d;
      d.n_l = 2 * v_h * n_h - n_v;
      d.n_v = n_v;
      d.n_h = n_h;
      d.h_sin2 = h_sin * h_sin;
      d.l_h = v_h;
      if (v_h <= 0 || d.n_l <= 0) continue;
      term(d, 4 * v_h / n_h * visibility(d) * share_weight / kAzimuths);
    }
  }
}

// Squared tangents of facets for IntegrateFacets.
struct GgxTilt {
  double roughness;
  double operator()(double share) const { return roughness * roughness * share / (1 - share); }
};
struct BeckmannTilt {
  double roughness;
  double operator()(double share) const { return -roughness * roughness * std::log1p(-share); }
};

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_RENDER_MATERIAL_FACET_INTEGRAL_H_
