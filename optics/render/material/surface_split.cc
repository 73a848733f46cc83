#include "optics/render/material/surface_split.h"

#include <algorithm>

#include "optics/render/material/rgb_sum.h"

namespace eyebox::optics {
namespace {

SurfaceSplit SplitMetallic(const Surface& surface, double dielectric, double diffuse_share) {
  const double grey = dielectric * (1 - surface.metallic);
  return {.diffuse = diffuse_share * surface.base,
          .specular = Rgb{grey, grey, grey} + surface.metallic * surface.base,
          .reflectivity = 1 - diffuse_share};
}

SurfaceSplit SplitSpecular(const Rgb& base, const Rgb& specular) {
  const double reflectivity = Largest(specular);
  return {.diffuse = (1 - reflectivity) * base, .specular = specular, .reflectivity = reflectivity};
}

}  // namespace

double Surface::Roughness(double floor) const {
  return std::max(PerceptualRoughness() * PerceptualRoughness(), floor);
}

SurfaceSplit SplitSurface(const Surface& surface, double dielectric) {
  if (surface.specular) return SplitSpecular(surface.base, *surface.specular);
  return SplitMetallic(surface, dielectric, (1 - dielectric) * (1 - surface.metallic));
}

SurfaceSplit SplitSurfaceHdrp(const Surface& surface) {
  if (surface.specular) return SplitSpecular(surface.base, *surface.specular);
  return SplitMetallic(surface, kDielectricSpecular, 1 - surface.metallic);
}

}  // namespace eyebox::optics
