#include "optics/render/material/standard.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "optics/render/material/microfacet.h"
#include "optics/render/material/rgb_sum.h"

namespace eyebox::optics {
namespace {

constexpr double kLeastGammaHighlight = 1e-4;

}  // namespace

SurfaceSplit Standard::Split() const {
  return SplitSurface(surface, gamma_mode ? kDielectricSpecularGamma : kDielectricSpecular);
}

// D V n.l
double Standard::Highlight(const Directions& d) const {
  const double roughness = surface.Roughness(kRoughnessFloor);
  const double visibility = smith == SmithForm::kExact
                                ? SmithVisibility(d.n_l, d.n_v, roughness)
                                : SmithVisibilityApproximate(d.n_l, d.n_v, roughness);
  const double lit = GgxDistribution(d, roughness) * visibility;
  if (!gamma_mode) return lit;
  const double least = std::sqrt(kLeastGammaHighlight) * d.n_l;
  return std::max(std::sqrt(std::numbers::pi * lit * d.n_l), least) / std::numbers::pi;
}

Rgb Standard::Reflected(const Directions& d) const {
  if (!d.InFront()) return {};
  const SurfaceSplit split = Split();
  Rgb reflected = {};
  if (!IsBlack(split.diffuse)) {
    const double disney = DisneyDiffuse(d, surface.PerceptualRoughness());
    reflected = (disney * d.n_l / std::numbers::pi) * split.diffuse;
  }
  // The shader leaves the highlight out where f0 is black, its Fresnel rise included.
  if (IsBlack(split.specular)) return reflected;
  return reflected + Highlight(d) * FresnelSchlick(d.l_h, split.specular);
}

Rgb Standard::AmbientReflected(double n_v) const {
  const SurfaceSplit split = Split();
  const double perceptual = surface.PerceptualRoughness();
  const double roughness = surface.Roughness(kRoughnessFloor);
  const double reduction =
      gamma_mode ? 1 - 0.28 * roughness * perceptual : 1 / (roughness * roughness + 1);
  const double grazing = std::min(surface.smoothness + split.reflectivity, 1.0);
  const double rise = Schlick5(n_v);
  const Rgb mirrored =
      (1 - rise) * split.specular + Rgb{rise * grazing, rise * grazing, rise * grazing};
  return split.diffuse + reduction * mirrored;
}

}  // namespace eyebox::optics
