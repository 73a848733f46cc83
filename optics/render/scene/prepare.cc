#include <cmath>
#include <numbers>

#include "optics/render/material/rgb_sum.h"
#include "optics/render/scene/scene.h"
#include "optics/render/srgb.h"

namespace eyebox::optics {
namespace {

Rgb Decoded(const Rgb& encoded) {
  return {SrgbToLinear(encoded[0]), SrgbToLinear(encoded[1]), SrgbToLinear(encoded[2])};
}

struct Decode {
  Unlit operator()(const Unlit& m) const { return {Decoded(m.colour)}; }
  Lambert operator()(const Lambert& m) const { return {Decoded(m.diffuse)}; }
  Phong operator()(const Phong& m) const {
    return {Decoded(m.diffuse), Decoded(m.specular), m.exponent};
  }
  BlinnPhong operator()(const BlinnPhong& m) const {
    return {Decoded(m.diffuse), Decoded(m.specular), m.exponent};
  }
  CookTorrance operator()(CookTorrance m) const {
    m.diffuse = Decoded(m.diffuse);
    if (auto* schlick = std::get_if<SchlickFresnel>(&m.fresnel)) schlick->f0 = Decoded(schlick->f0);
    return m;
  }
  template <typename Lit>
  Lit operator()(Lit m) const {
    m.surface.base = Decoded(m.surface.base);
    if (m.surface.specular) m.surface.specular = Decoded(*m.surface.specular);
    return m;
  }
};

Material PrepareMaterial(const Material& material, Renderer renderer) {
  if (renderer == Renderer::kBuiltInGamma) {
    Material kept = material;
    if (auto* lit = std::get_if<LitMaterial>(&kept)) {
      if (auto* standard = std::get_if<Standard>(lit)) standard->gamma_mode = true;
    }
    return kept;
  }
  if (const auto* unlit = std::get_if<Unlit>(&material)) return Decode{}(*unlit);
  return std::visit([](const auto& m) -> Material { return LitMaterial(Decode{}(m)); },
                    std::get<LitMaterial>(material));
}

void RaiseFloor(const RendererSettings& settings, Material& material) {
  auto* lit = std::get_if<LitMaterial>(&material);
  auto* lambert = lit == nullptr ? nullptr : std::get_if<Lambert>(lit);
  if (lambert == nullptr) return;
  const double floor = settings.reflectance_floor / settings.rendering_constant;
  lambert->diffuse = lambert->diffuse + Rgb{floor, floor, floor};
}

// Scene-linear colour with which an intensity of 1 lights.
struct LightScale {
  Renderer renderer;

  // Colour times intensity, of a small light.
  Rgb Small(const Rgb& colour, double intensity) const {
    switch (renderer) {
      case Renderer::kHdrp:
        return intensity * Decoded(colour);
      case Renderer::kUrp:
        return (std::numbers::pi * intensity) * Decoded(colour);
      case Renderer::kBuiltInGamma:
        return (std::numbers::pi * intensity) * colour;
      case Renderer::kBuiltInLinear:
        return std::numbers::pi * Decoded(intensity * colour);
    }
    return {};
  }
  Rgb Surround(const Rgb& colour, double intensity) const {
    switch (renderer) {
      case Renderer::kHdrp:
      case Renderer::kBuiltInGamma:
        return intensity * colour;
      case Renderer::kUrp:
        return intensity * Decoded(colour);
      case Renderer::kBuiltInLinear:
        return Decoded(intensity * colour);
    }
    return {};
  }
};

struct AddLight {
  PreparedScene& scene;
  LightScale scale;
  size_t index;

  void operator()(DirectionalLight light) const {
    light.colour = scale.Small(light.colour, light.illuminance_lux);
    light.illuminance_lux = 1;
    if (!IsBlack(light.colour)) scene.sources.push_back({light, index});
  }
  void operator()(PointLight light) const {
    if (Prepared(light)) scene.sources.push_back({light, index});
  }
  void operator()(SpotLight light) const {
    if (Prepared(light.source)) scene.sources.push_back({ConeOf(light), index});
  }
  void operator()(const AmbientLight& light) const {
    scene.ambient = scene.ambient + scale.Surround(light.colour, light.luminance_cd_m2);
  }
  bool Prepared(PointLight& light) const {
    light.colour = scale.Small(light.colour, light.intensity_cd);
    light.intensity_cd = 1;
    return !IsBlack(light.colour);
  }
};

}  // namespace

PreparedScene Prepare(const Scene& scene) {
  PreparedScene prepared;
  const RendererSettings& settings = scene.settings;
  for (const Material& material : scene.materials) {
    prepared.materials.push_back(PrepareMaterial(material, settings.renderer));
  }
  if (settings.renderer == Renderer::kHdrp && settings.reflectance_floor != 0) {
    for (Material& material : prepared.materials) RaiseFloor(settings, material);
  }
  for (size_t i = 0; i < scene.lights.size(); ++i) {
    std::visit(AddLight{prepared, {settings.renderer}, i}, scene.lights[i]);
  }
  if (settings.renderer == Renderer::kHdrp) {
    prepared.exposure = settings.rendering_constant * std::exp2(-settings.exposure_ev);
  }
  return prepared;
}

}  // namespace eyebox::optics
