#include "optics/render/material/material.h"

#include "optics/render/material/rgb_sum.h"

namespace eyebox::optics {
namespace {

struct Name {
  std::string_view operator()(const Lambert&) const { return "lambert"; }
  std::string_view operator()(const Phong&) const { return "phong"; }
  std::string_view operator()(const BlinnPhong&) const { return "blinn_phong"; }
  std::string_view operator()(const CookTorrance&) const { return "cook_torrance"; }
  std::string_view operator()(const Standard&) const { return "standard"; }
  std::string_view operator()(const UrpLit&) const { return "urp_lit"; }
  std::string_view operator()(const HdrpLit&) const { return "hdrp_lit"; }
};

struct LobesFor {
  Lobes operator()(const Lambert& m) const { return {.diffuse = !IsBlack(m.diffuse)}; }
  Lobes operator()(const Phong& m) const { return {!IsBlack(m.diffuse), !IsBlack(m.specular)}; }
  Lobes operator()(const BlinnPhong& m) const {
    return {!IsBlack(m.diffuse), !IsBlack(m.specular)};
  }
  Lobes operator()(const CookTorrance& m) const { return {!IsBlack(m.diffuse), true}; }
  Lobes operator()(const Standard& m) const {
    const SurfaceSplit split = m.Split();
    return {!IsBlack(split.diffuse), !IsBlack(split.specular)};
  }
  Lobes operator()(const UrpLit& m) const {
    const SurfaceSplit split = SplitSurface(m.surface, kDielectricSpecular);
    return {!IsBlack(split.diffuse), !IsBlack(split.specular)};
  }
  Lobes operator()(const HdrpLit& m) const {
    return {!IsBlack(SplitSurfaceHdrp(m.surface).diffuse), true};
  }
};

struct ClaimsFor {
  Lobes lobes;

  Claims operator()(const Lambert& m) const { return {true, Largest(m.diffuse) <= 1}; }
  Claims operator()(const Phong& m) const {
    return {!lobes.specular, !lobes.specular && Largest(m.diffuse) <= 1};
  }
  Claims operator()(const BlinnPhong& m) const {
    return {!lobes.specular, !lobes.specular && Largest(m.diffuse) <= 1};
  }
  Claims operator()(const CookTorrance& m) const {
    return {true, m.scale == HighlightScale::kNormalised && !lobes.diffuse};
  }
  Claims operator()(const Standard& m) const {
    // In Gamma mode n.l stands outside the square root, n.v within: still the same both ways round.
    return {true, !m.gamma_mode && !lobes.diffuse && m.smith == SmithForm::kExact};
  }
  Claims operator()(const UrpLit&) const { return {true, !lobes.specular}; }
  Claims operator()(const HdrpLit& m) const {
    return {!m.energy_compensation, !m.energy_compensation && !lobes.diffuse};
  }
};

}  // namespace

std::string_view NameOf(const LitMaterial& material) { return std::visit(Name{}, material); }

Lobes LobesOf(const LitMaterial& material) { return std::visit(LobesFor{}, material); }

Claims ClaimsOf(const LitMaterial& material) {
  return std::visit(ClaimsFor{LobesOf(material)}, material);
}

}  // namespace eyebox::optics
