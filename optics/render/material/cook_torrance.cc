#include "optics/render/material/cook_torrance.h"

#include <algorithm>
#include <numbers>

#include "optics/render/material/facet_integral.h"
#include "optics/render/material/microfacet.h"
#include "optics/render/material/rgb_sum.h"

namespace eyebox::optics {
namespace {

struct FresnelAt {
  double u;
  Rgb operator()(const DielectricFresnel& fresnel) const {
    const double f = FresnelExact(u, fresnel.index);
    return {f, f, f};
  }
  Rgb operator()(const SchlickFresnel& fresnel) const { return FresnelSchlick(u, fresnel.f0); }
};

}  // namespace

Rgb CookTorrance::Highlight(const Directions& d, double shadowed_density) const {
  const double factor = scale == HighlightScale::kPublished ? 4 : 1;
  return (factor * shadowed_density) * std::visit(FresnelAt{d.l_h}, fresnel);
}

Rgb CookTorrance::Reflected(const Directions& d) const {
  if (!d.InFront()) return {};
  const double m = std::max(roughness, kRoughnessFloor);
  const Rgb highlight = Highlight(d, BeckmannDistribution(d, m) * CavityVisibility(d));
  return (d.n_l / std::numbers::pi) * diffuse + highlight;
}

Rgb CookTorrance::AmbientReflected(double n_v) const {
  Rgb sum = diffuse;
  IntegrateFacets(n_v, BeckmannTilt{std::max(roughness, kRoughnessFloor)}, CavityVisibility,
                  [&](const Directions& d, double factor) { sum = sum + Highlight(d, factor); });
  return sum;
}

}  // namespace eyebox::optics
