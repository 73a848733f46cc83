// A scene: materials under lights, seen by an eye, as one of Unity's renderers shades it.
#ifndef EYEBOX_OPTICS_RENDER_SCENE_SCENE_H_
#define EYEBOX_OPTICS_RENDER_SCENE_SCENE_H_

#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "optics/render/material/material.h"
#include "optics/render/scene/light.h"

namespace eyebox::optics {

enum class Renderer { kHdrp, kUrp, kBuiltInGamma, kBuiltInLinear };
std::string_view NameOf(Renderer renderer);  // "hdrp", "urp", "built_in_gamma", "built_in_linear"

struct RendererSettings {
  Renderer renderer = Renderer::kHdrp;
  double exposure_ev = 0;             // e, HDRP's Fixed Exposure: lit colours are divided by 2^e
  double rendering_constant = 0.822;  // c of HDRP (HDRP model, eq 2); 1 for the others
  // Of HDRP's Lambertian: c s(m) + this is what a colour reflects; 0 as published.
  double reflectance_floor = 0;
};

// Shows its colour whatever the light and the exposure (HDRP model, eq 3).
struct Unlit {
  Rgb colour = {1, 1, 1};
};
using Material = std::variant<Unlit, LitMaterial>;

// Where one looks: a small piece of surface.
struct Patch {
  size_t material = 0;  // index
  Vec3 position_m;
  Vec3 normal = {0, 0, -1};  // unit
  Vec3 view = {0, 0, -1};    // unit, towards the eye
};

// Colours are as typed in Unity (display-encoded, apart from an ambient light's in HDRP).
struct Scene {
  RendererSettings settings;
  std::vector<Material> materials;
  std::vector<Light> lights;
};

// A scene made ready: colours scene-linear, black lights and settings without effect gone.
struct PreparedScene {
  struct Source {
    std::variant<DirectionalLight, PointLight, SpotCone> light;
    size_t index = 0;  // in Scene::lights
  };
  std::vector<Material> materials;
  std::vector<Source> sources;
  Rgb ambient = {};     // radiance of the surround, all ambient lights together
  double exposure = 1;  // factor on what lit materials reflect
};

// Encoded colours c become s(c), the HDRP ambient colour stays as it is (HDRP model, eq 2). In the
// built-in pipeline and URP a light of intensity 1 lights white to 1: it is an irradiance of pi.
// Gamma mode computes with what was typed. Built-in Linear mode transforms intensity times colour,
// as lightsUseLinearIntensity is off by default there (Unity scripting reference); v = s^-1(u) of
// this is the behaviour published as inconsistent (Murray, Patel and Wiedenmann, fig 2): compressed
// as a function of the angle (2b), yet equal to Gamma mode as a function of the colour at normal
// incidence (2c), because the colour was decoded before. How it treats ambient light is not
// published: taken as intensity times colour, transformed.
PreparedScene Prepare(const Scene& scene);

// Light that leaves a patch, exposed, apart as some renderers store it: of all other lights, and of
// ambient light. An unlit colour is direct.
struct ShadedParts {
  Rgb direct = {};
  Rgb ambient = {};
};
// Their sum is u, the scene-linear colour before post-processing (Gamma mode: the drive value
// before clamping). `patch.view` must not be behind the surface. Computes only what contributes.
ShadedParts ShadeParts(const PreparedScene& scene, const Patch& patch);
Rgb Shade(const PreparedScene& scene, const Patch& patch);

// What became of each light of the scene at a patch.
enum class LightUse {
  kShaded,      // contributed
  kUnlit,       // the material does not look at light
  kBlack,       // no intensity or black
  kBehind,      // below the patch's horizon
  kOutOfReach,  // beyond its range or outside its cone
};
std::string_view NameOf(LightUse use);

struct TermsUsed {
  std::vector<LightUse> lights;  // [lights of the scene]
  Lobes lobes;                   // of the material, none where no light contributes
  bool ambient = false;
  bool view = false;  // whether the direction of the eye mattered
};
TermsUsed ExplainShading(const Scene& scene, const PreparedScene& prepared, const Patch& patch);

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_RENDER_SCENE_SCENE_H_
