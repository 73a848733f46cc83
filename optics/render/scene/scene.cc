#include "optics/render/scene/scene.h"

#include <algorithm>

#include "optics/render/material/rgb_sum.h"

namespace eyebox::optics {
namespace {

Arrival ArrivalOf(const PreparedScene::Source& source, const Vec3& position_m) {
  return std::visit([&](const auto& light) { return ArrivalAt(light, position_m); }, source.light);
}

// Reflected light of one material, with whatever its view needs computed once and only if a light
// asks for it.
template <typename Lit>
class Reflector {
 public:
  explicit Reflector(const Lit& material) : material_(material) {}
  Rgb operator()(const Directions& d) { return material_.Reflected(d); }

 private:
  const Lit& material_;
};

template <>
class Reflector<HdrpLit> {
 public:
  explicit Reflector(const HdrpLit& material) : material_(material) {}
  Rgb operator()(const Directions& d) {
    if (!compensation_) compensation_ = material_.Compensation(d.n_v);
    return material_.Reflected(d, *compensation_);
  }

 private:
  const HdrpLit& material_;
  std::optional<Rgb> compensation_;
};

struct ShadeLit {
  const PreparedScene& scene;
  const Patch& patch;

  template <typename Lit>
  ShadedParts operator()(const Lit& material) const {
    Reflector<Lit> reflector(material);
    ShadedParts parts;
    for (const PreparedScene::Source& source : scene.sources) {
      const Arrival arrival = ArrivalOf(source, patch.position_m);
      if (IsBlack(arrival.illuminance_lux) || Dot(patch.normal, arrival.towards) <= 0) continue;
      const Directions d = DirectionsBetween(patch.normal, arrival.towards, patch.view);
      parts.direct = parts.direct + arrival.illuminance_lux * reflector(d);
    }
    parts.direct = scene.exposure * parts.direct;
    if (IsBlack(scene.ambient)) return parts;
    const double n_v = std::clamp(Dot(patch.normal, patch.view), 0.0, 1.0);
    parts.ambient = scene.exposure * (scene.ambient * material.AmbientReflected(n_v));
    return parts;
  }
};

LightUse UseOf(const PreparedScene::Source& source, const Patch& patch) {
  const Arrival arrival = ArrivalOf(source, patch.position_m);
  if (IsBlack(arrival.illuminance_lux)) return LightUse::kOutOfReach;
  return Dot(patch.normal, arrival.towards) > 0 ? LightUse::kShaded : LightUse::kBehind;
}

bool LooksAtView(const LitMaterial& material, bool ambient, bool sources) {
  const Lobes lobes = LobesOf(material);
  const bool lambert_like = std::holds_alternative<Lambert>(material) ||
                            std::holds_alternative<Phong>(material) ||
                            std::holds_alternative<BlinnPhong>(material);
  if (lambert_like) return sources && lobes.specular;
  return sources || ambient;
}

}  // namespace

std::string_view NameOf(Renderer renderer) {
  switch (renderer) {
    case Renderer::kHdrp:
      return "hdrp";
    case Renderer::kUrp:
      return "urp";
    case Renderer::kBuiltInGamma:
      return "built_in_gamma";
    case Renderer::kBuiltInLinear:
      return "built_in_linear";
  }
  return "";
}

std::string_view NameOf(LightUse use) {
  switch (use) {
    case LightUse::kShaded:
      return "shaded";
    case LightUse::kUnlit:
      return "not asked for by an unlit material";
    case LightUse::kBlack:
      return "black";
    case LightUse::kBehind:
      return "below the horizon of the patch";
    case LightUse::kOutOfReach:
      return "out of reach";
  }
  return "";
}

ShadedParts ShadeParts(const PreparedScene& scene, const Patch& patch) {
  const Material& material = scene.materials[patch.material];
  if (const auto* unlit = std::get_if<Unlit>(&material)) return {.direct = unlit->colour};
  return std::visit(ShadeLit{scene, patch}, std::get<LitMaterial>(material));
}

Rgb Shade(const PreparedScene& scene, const Patch& patch) {
  const ShadedParts parts = ShadeParts(scene, patch);
  return parts.direct + parts.ambient;
}

TermsUsed ExplainShading(const Scene& scene, const PreparedScene& prepared, const Patch& patch) {
  TermsUsed used;
  const auto* lit = std::get_if<LitMaterial>(&prepared.materials[patch.material]);
  used.lights.assign(scene.lights.size(), lit == nullptr ? LightUse::kUnlit : LightUse::kBlack);
  if (lit == nullptr) return used;
  bool sources = false;
  for (const PreparedScene::Source& source : prepared.sources) {
    used.lights[source.index] = UseOf(source, patch);
    sources = sources || used.lights[source.index] == LightUse::kShaded;
  }
  for (size_t i = 0; i < scene.lights.size(); ++i) {
    const auto* ambient = std::get_if<AmbientLight>(&scene.lights[i]);
    if (ambient == nullptr || ambient->luminance_cd_m2 == 0 || IsBlack(ambient->colour)) continue;
    used.lights[i] = LightUse::kShaded;
    used.ambient = true;
  }
  if (sources || used.ambient) used.lobes = LobesOf(*lit);
  used.view = LooksAtView(*lit, used.ambient, sources);
  return used;
}

}  // namespace eyebox::optics
