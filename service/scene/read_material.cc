#include "absl/strings/str_cat.h"
#include "capture/base/status.h"
#include "service/scene/read_scene.h"
#include "service/scene/scene_field.h"

namespace eyebox::service {
namespace {

using optics::LitMaterial;
using optics::Material;
using optics::Renderer;
using v1::SceneMaterial;

constexpr Range kExponentRange = {.least = 1};
constexpr Range kSlopeRange = {.most = 1, .above_least = true};

template <typename Model>
absl::StatusOr<Material> ReadHighlight(const v1::HighlightMaterial& proto,
                                       const SceneField& field) {
  Model model;
  EYEBOX_ASSIGN_OR_RETURN(model.diffuse, field.Of("diffuse").Color(proto.diffuse(), kUnitRange));
  EYEBOX_ASSIGN_OR_RETURN(model.specular, field.Of("specular").Color(proto.specular(), kUnitRange));
  EYEBOX_ASSIGN_OR_RETURN(model.exponent,
                          field.Of("exponent").Number(proto.exponent(), kExponentRange));
  return LitMaterial(model);
}

absl::StatusOr<Material> ReadCookTorrance(const v1::CookTorranceMaterial& proto,
                                          const SceneField& field) {
  optics::CookTorrance model;
  EYEBOX_ASSIGN_OR_RETURN(model.diffuse, field.Of("diffuse").Color(proto.diffuse(), kUnitRange));
  EYEBOX_ASSIGN_OR_RETURN(model.roughness,
                          field.Of("roughness").Number(proto.roughness(), kSlopeRange));
  if (proto.has_refractive_index()) {
    optics::DielectricFresnel dielectric;
    EYEBOX_ASSIGN_OR_RETURN(
        dielectric.index,
        field.Of("refractive_index").Number(proto.refractive_index(), kAboveZero));
    model.fresnel = dielectric;
  } else if (proto.has_f0()) {
    optics::SchlickFresnel schlick;
    EYEBOX_ASSIGN_OR_RETURN(schlick.f0, field.Of("f0").Color(proto.f0(), kUnitRange));
    model.fresnel = schlick;
  } else {
    return field.Refuse("says nothing of what its facets reflect", "give refractive_index or f0");
  }
  if (proto.normalized()) model.scale = optics::HighlightScale::kNormalised;
  return LitMaterial(model);
}

absl::StatusOr<optics::Surface> ReadSurface(const v1::SurfaceMaterial& proto,
                                            const SceneField& field) {
  optics::Surface surface;
  EYEBOX_ASSIGN_OR_RETURN(surface.base,
                          field.Of("base_color").Color(proto.base_color(), kUnitRange));
  EYEBOX_ASSIGN_OR_RETURN(surface.smoothness,
                          field.Of("smoothness").Number(proto.smoothness(), kUnitRange));
  EYEBOX_ASSIGN_OR_RETURN(surface.metallic,
                          field.Of("metallic").Number(proto.metallic(), kUnitRange));
  if (proto.has_specular()) {
    EYEBOX_ASSIGN_OR_RETURN(surface.specular,
                            field.Of("specular").Color(proto.specular(), kUnitRange));
  }
  return surface;
}

absl::Status CheckShader(const SceneField& field, std::string_view shader, bool fits,
                         Renderer renderer) {
  if (fits) return absl::OkStatus();
  const char* own = renderer == Renderer::kHdrp  ? "hdrp_lit"
                    : renderer == Renderer::kUrp ? "urp_lit"
                                                 : "standard";
  return field.Refuse(absl::StrCat("is ", std::string(shader), ", a shader of another pipeline"),
                      absl::StrCat("use ", own, " or another renderer"));
}

absl::StatusOr<Material> ReadUnity(const SceneMaterial& proto, Renderer renderer,
                                   const SceneField& field) {
  const bool built_in = renderer == Renderer::kBuiltInGamma || renderer == Renderer::kBuiltInLinear;
  if (proto.has_standard()) {
    EYEBOX_RETURN_IF_ERROR(CheckShader(field, "standard", built_in, renderer));
    optics::Standard model;
    EYEBOX_ASSIGN_OR_RETURN(model.surface, ReadSurface(proto.standard(), field.Of("standard")));
    if (proto.standard().simplified_visibility()) model.smith = optics::SmithForm::kShader;
    return LitMaterial(model);
  }
  if (proto.has_urp_lit()) {
    EYEBOX_RETURN_IF_ERROR(CheckShader(field, "urp_lit", renderer == Renderer::kUrp, renderer));
    optics::UrpLit model;
    EYEBOX_ASSIGN_OR_RETURN(model.surface, ReadSurface(proto.urp_lit(), field.Of("urp_lit")));
    return LitMaterial(model);
  }
  EYEBOX_RETURN_IF_ERROR(CheckShader(field, "hdrp_lit", renderer == Renderer::kHdrp, renderer));
  optics::HdrpLit model;
  EYEBOX_ASSIGN_OR_RETURN(model.surface, ReadSurface(proto.hdrp_lit(), field.Of("hdrp_lit")));
  model.energy_compensation = !proto.hdrp_lit().without_energy_compensation();
  return LitMaterial(model);
}

}  // namespace

absl::StatusOr<Material> ReadMaterial(const SceneMaterial& material, Renderer renderer,
                                      const std::string& where) {
  const SceneField field = {where};
  switch (material.model_case()) {
    case SceneMaterial::kUnlit: {
      optics::Unlit unlit;
      EYEBOX_ASSIGN_OR_RETURN(unlit.colour,
                              field.Of("unlit color").Color(material.unlit().color(), kUnitRange));
      return unlit;
    }
    case SceneMaterial::kLambert: {
      optics::Lambert lambert;
      EYEBOX_ASSIGN_OR_RETURN(
          lambert.diffuse, field.Of("lambert color").Color(material.lambert().color(), kUnitRange));
      return LitMaterial(lambert);
    }
    case SceneMaterial::kPhong:
      return ReadHighlight<optics::Phong>(material.phong(), field.Of("phong"));
    case SceneMaterial::kBlinnPhong:
      return ReadHighlight<optics::BlinnPhong>(material.blinn_phong(), field.Of("blinn_phong"));
    case SceneMaterial::kCookTorrance:
      return ReadCookTorrance(material.cook_torrance(), field.Of("cook_torrance"));
    case SceneMaterial::kStandard:
    case SceneMaterial::kUrpLit:
    case SceneMaterial::kHdrpLit:
      return ReadUnity(material, renderer, field);
    case SceneMaterial::MODEL_NOT_SET:
      break;
  }
  return field.Refuse("has no model",
                      "give unlit, lambert, phong, blinn_phong, cook_torrance, "
                      "standard, urp_lit or hdrp_lit");
}

}  // namespace eyebox::service
