#include "service/scene/read_scene.h"

#include <algorithm>

#include "absl/strings/str_cat.h"
#include "capture/base/file.h"
#include "capture/base/status.h"
#include "capture/recording/text_format.h"
#include "service/scene/scene_field.h"

namespace eyebox::service {
namespace {

using optics::Renderer;

constexpr size_t kLargestSceneFile = size_t{1} << 20;

absl::StatusOr<Renderer> ReadRenderer(v1::SceneRenderer renderer, const SceneField& field) {
  switch (renderer) {
    case v1::SCENE_RENDERER_HDRP:
      return Renderer::kHdrp;
    case v1::SCENE_RENDERER_URP:
      return Renderer::kUrp;
    case v1::SCENE_RENDERER_BUILT_IN_GAMMA:
      return Renderer::kBuiltInGamma;
    case v1::SCENE_RENDERER_BUILT_IN_LINEAR:
      return Renderer::kBuiltInLinear;
    default:
      return field.Refuse("is not given",
                          "give SCENE_RENDERER_HDRP, _URP, _BUILT_IN_GAMMA or "
                          "_BUILT_IN_LINEAR");
  }
}

absl::Status AddName(const std::string& name, const SceneField& field,
                     std::vector<std::string>& names) {
  if (name.empty()) return field.Refuse("has no name", "name it");
  if (std::find(names.begin(), names.end(), name) != names.end()) {
    return field.Refuse("has a name that is taken", "names must differ");
  }
  names.push_back(name);
  return absl::OkStatus();
}

// What exists in HDRP alone must not be passed over silently elsewhere.
absl::Status ReadSettings(const v1::Scene& proto, const SceneField& field, SceneInput& input) {
  optics::RendererSettings& settings = input.scene.settings;
  EYEBOX_ASSIGN_OR_RETURN(settings.renderer, ReadRenderer(proto.renderer(), field.Of("renderer")));
  EYEBOX_ASSIGN_OR_RETURN(settings.exposure_ev,
                          field.Of("exposure_ev").Number(proto.exposure_ev(), {-100, 100}));
  input.has_rendering_constant = proto.has_rendering_constant();
  if (input.has_rendering_constant) {
    EYEBOX_ASSIGN_OR_RETURN(
        settings.rendering_constant,
        field.Of("rendering_constant").Number(proto.rendering_constant(), kAboveZero));
  }
  if (!proto.cube_file().empty()) {
    input.cube = std::filesystem::path(input.file).parent_path() / proto.cube_file();
  }
  if (settings.renderer == Renderer::kHdrp) return absl::OkStatus();
  const char* odd = settings.exposure_ev != 0           ? "exposure_ev"
                    : proto.has_rendering_constant()    ? "rendering_constant"
                    : input.cube.extension() == ".cube" ? "cube_file"
                    : proto.has_pass_through()          ? "pass_through"
                                                        : nullptr;
  if (odd == nullptr) return absl::OkStatus();
  return field.Of(odd).Refuse("is a setting of HDRP", "leave it out for this renderer");
}

absl::Status ReadLists(const v1::Scene& proto, const SceneField& field, SceneInput& input) {
  for (int i = 0; i < proto.materials_size(); ++i) {
    const v1::SceneMaterial& material = proto.materials(i);
    const SceneField entry = field.Entry("materials", i, material.name());
    EYEBOX_RETURN_IF_ERROR(AddName(material.name(), entry, input.material_names));
    EYEBOX_ASSIGN_OR_RETURN(optics::Material read,
                            ReadMaterial(material, input.scene.settings.renderer, entry.where));
    input.scene.materials.push_back(read);
  }
  for (int i = 0; i < proto.lights_size(); ++i) {
    const SceneField entry = field.Entry("lights", i, proto.lights(i).name());
    EYEBOX_RETURN_IF_ERROR(AddName(proto.lights(i).name(), entry, input.light_names));
    EYEBOX_ASSIGN_OR_RETURN(optics::Light read, ReadLight(proto.lights(i), entry.where));
    input.scene.lights.push_back(read);
  }
  return absl::OkStatus();
}

// An eye that does not matter is put in front of the patch.
absl::Status LookAt(const v1::Scene& proto, const SceneField& field, const SceneInput& input,
                    optics::Patch& patch) {
  patch.view = patch.normal;
  if (!proto.has_eye_position_m()) {
    if (!optics::ExplainShading(input.scene, optics::Prepare(input.scene), patch).view) {
      return absl::OkStatus();
    }
    return field.Refuse("looks different from everywhere and there is no eye_position_m",
                        "give it");
  }
  EYEBOX_ASSIGN_OR_RETURN(const optics::Vec3 eye,
                          field.Of("eye_position_m").Place(proto.eye_position_m()));
  const optics::Vec3 to_eye = eye - patch.position_m;
  if (!(optics::Length(to_eye) > 0)) return field.Refuse("is where the eye is", "move either");
  patch.view = optics::Normalised(to_eye);
  if (optics::Dot(patch.normal, patch.view) > 0) return absl::OkStatus();
  return field.Refuse("turns its back to the eye, or its edge",
                      "turn its normal, or move eye_position_m");
}

absl::Status ReadPatchField(const v1::ScenePatch& source, const SceneField& field,
                            SceneInput& input) {
  PatchField used;
  if (source.has_within_deg()) {
    EYEBOX_ASSIGN_OR_RETURN(used.within_deg,
                            field.Of("within_deg").Number(source.within_deg(), {0, 90, true}));
  }
  if (source.has_diameter_deg()) {
    EYEBOX_ASSIGN_OR_RETURN(used.diameter_deg,
                            field.Of("diameter_deg").Number(source.diameter_deg(), {0, 180, true}));
  }
  input.patch_fields.push_back(used);
  return absl::OkStatus();
}

absl::Status ReadPatch(const v1::Scene& proto, int index, const SceneField& field,
                       SceneInput& input) {
  const v1::ScenePatch& source = proto.patches(index);
  EYEBOX_RETURN_IF_ERROR(AddName(source.name(), field, input.patch_names));
  const auto& names = input.material_names;
  const auto found = std::find(names.begin(), names.end(), source.material());
  if (found == names.end()) {
    return field.Of("material")
        .Refuse("is '" + source.material() + "', which is not in the scene",
                "name one of its materials");
  }
  optics::Patch patch;
  patch.material = static_cast<size_t>(found - names.begin());
  EYEBOX_ASSIGN_OR_RETURN(patch.position_m, field.Of("position_m").Place(source.position_m()));
  if (source.has_normal()) {
    EYEBOX_ASSIGN_OR_RETURN(patch.normal, field.Of("normal").Direction(source.normal()));
  }
  EYEBOX_RETURN_IF_ERROR(LookAt(proto, field, input, patch));
  input.patches.push_back(patch);
  return ReadPatchField(source, field, input);
}

}  // namespace

absl::StatusOr<SceneInput> ParseScene(const std::string& text, const std::filesystem::path& file) {
  v1::Scene proto;
  EYEBOX_RETURN_IF_ERROR(capture::ParseText(text, file, proto));
  const SceneField field = {file.string()};
  SceneInput input;
  input.file = file.string();
  EYEBOX_RETURN_IF_ERROR(ReadSettings(proto, field, input));
  EYEBOX_RETURN_IF_ERROR(ReadLists(proto, field, input));
  if (proto.patches_size() == 0) return field.Refuse("has no patches", "say what is looked at");
  for (int i = 0; i < proto.patches_size(); ++i) {
    EYEBOX_RETURN_IF_ERROR(
        ReadPatch(proto, i, field.Entry("patches", i, proto.patches(i).name()), input));
  }
  if (proto.has_pass_through()) {
    EYEBOX_ASSIGN_OR_RETURN(input.mixed_reality,
                            ReadPassThrough(proto.pass_through(), field.Of("pass_through").where));
  }
  return input;
}

absl::StatusOr<SceneInput> ReadScene(const std::filesystem::path& file) {
  EYEBOX_ASSIGN_OR_RETURN(const std::string text, ReadWholeFile(file, kLargestSceneFile));
  return ParseScene(text, file);
}

}  // namespace eyebox::service
