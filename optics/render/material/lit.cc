#include "optics/render/material/lit.h"

#include <algorithm>
#include <numbers>

#include "optics/render/material/facet_integral.h"
#include "optics/render/material/microfacet.h"
#include "optics/render/material/rgb_sum.h"

namespace eyebox::optics {
namespace {

constexpr double kUrpLeastLh2 = 0.1;
constexpr double kUrpSpread = 1e-5;

// A highlight's share of a uniform surround is f0 `flat` + (1 - f0) `rise`.
struct HighlightAlbedo {
  double flat = 0;
  double rise = 0;
};

HighlightAlbedo AlbedoOf(double n_v, double roughness) {
  HighlightAlbedo albedo;
  const auto visibility = [&](const Directions& d) {
    return SmithVisibility(d.n_l, d.n_v, roughness);
  };
  IntegrateFacets(n_v, GgxTilt{roughness}, visibility, [&](const Directions& d, double factor) {
    albedo.flat += factor;
    albedo.rise += factor * Schlick5(d.l_h);
  });
  return albedo;
}

Rgb CompensationFor(const Rgb& f0, const HighlightAlbedo& albedo) {
  if (albedo.flat <= 0) return {1, 1, 1};
  const double lost = 1 / albedo.flat - 1;
  return Rgb{1, 1, 1} + lost * f0;
}

// Disney diffuse over the hemisphere, in cosines and azimuths of the light.
double DisneyAlbedo(double n_v, double perceptual_roughness) {
  constexpr int kAzimuths = 24;
  const double v_sin = std::sqrt(std::max(0.0, 1 - n_v * n_v));
  double sum = 0;
  for (const UnitNode& node : UnitNodes()) {
    const double l_sin = std::sqrt(1 - node.x * node.x);
    for (int k = 0; k < kAzimuths; ++k) {
      const double azimuth = std::numbers::pi * (k + 0.5) / kAzimuths;
      const double l_v = n_v * node.x + v_sin * l_sin * std::cos(azimuth);
      Directions d;
      d.n_l = node.x;
      d.n_v = n_v;
      d.l_h = std::sqrt(std::max(0.0, (1 + l_v) / 2));
      sum += node.weight * 2 * node.x * DisneyDiffuse(d, perceptual_roughness) / kAzimuths;
    }
  }
  return sum;
}

}  // namespace

Rgb UrpLit::Reflected(const Directions& d) const {
  if (!d.InFront()) return {};
  const SurfaceSplit split = SplitSurface(surface, kDielectricSpecular);
  const Rgb diffuse = (d.n_l / std::numbers::pi) * split.diffuse;
  if (IsBlack(split.specular)) return diffuse;
  const double r = surface.Roughness(kRoughnessFloor);
  const double spread = d.h_sin2 + r * r * d.n_h * d.n_h + kUrpSpread;
  const double highlight =
      r * r / (spread * spread * std::max(kUrpLeastLh2, d.l_h * d.l_h) * (4 * r + 2));
  return diffuse + (highlight * d.n_l / std::numbers::pi) * split.specular;
}

Rgb UrpLit::AmbientReflected(double n_v) const {
  const SurfaceSplit split = SplitSurface(surface, kDielectricSpecular);
  const double r = surface.Roughness(kRoughnessFloor);
  const double grazing = std::min(surface.smoothness + split.reflectivity, 1.0);
  const double w = 1 - n_v;
  const double rise = w * w * w * w;
  const Rgb mirrored = (1 - rise) * split.specular + rise * Rgb{grazing, grazing, grazing};
  return split.diffuse + (1 / (r * r + 1)) * mirrored;
}

Rgb HdrpLit::Compensation(double n_v) const {
  const SurfaceSplit split = SplitSurfaceHdrp(surface);
  if (!energy_compensation || IsBlack(split.specular) || n_v < 0) return {1, 1, 1};
  return CompensationFor(split.specular, AlbedoOf(n_v, surface.Roughness(kRoughnessFloor)));
}

Rgb HdrpLit::Reflected(const Directions& d, const Rgb& compensation) const {
  if (!d.InFront()) return {};
  const SurfaceSplit split = SplitSurfaceHdrp(surface);
  Rgb reflected = {};
  if (!IsBlack(split.diffuse)) {
    const double disney = kDisneyScale * DisneyDiffuse(d, surface.PerceptualRoughness());
    reflected = (disney * d.n_l / std::numbers::pi) * split.diffuse;
  }
  const double roughness = surface.Roughness(kRoughnessFloor);
  const double highlight = GgxDistribution(d, roughness) * SmithVisibility(d.n_l, d.n_v, roughness);
  return reflected + highlight * (compensation * FresnelSchlick(d.l_h, split.specular));
}

Rgb HdrpLit::AmbientReflected(double n_v) const {
  const SurfaceSplit split = SplitSurfaceHdrp(surface);
  Rgb reflected = {};
  if (!IsBlack(split.diffuse)) {
    reflected = (kDisneyScale * DisneyAlbedo(n_v, surface.PerceptualRoughness())) * split.diffuse;
  }
  const HighlightAlbedo albedo = AlbedoOf(n_v, surface.Roughness(kRoughnessFloor));
  const Rgb white = {1 - split.specular[0], 1 - split.specular[1], 1 - split.specular[2]};
  const Rgb highlight = albedo.flat * split.specular + albedo.rise * white;
  if (!energy_compensation) return reflected + highlight;
  return reflected + CompensationFor(split.specular, albedo) * highlight;
}

}  // namespace eyebox::optics
