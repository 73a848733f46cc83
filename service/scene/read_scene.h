// A scene file as the renderer model takes it.
#ifndef EYEBOX_SERVICE_SCENE_READ_SCENE_H_
#define EYEBOX_SERVICE_SCENE_READ_SCENE_H_

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "eyebox/v1/scene.pb.h"
#include "optics/render/scene/mixed_reality.h"
#include "optics/render/scene/scene.h"

namespace eyebox::service {

struct MixedReality {
  optics::PassThroughCamera camera;
  optics::WhiteBalance balance;
  int bits = 8;
  bool match_exposure = false;
};

// What of the field a patch uses, visual angles.
struct PatchField {
  std::optional<double> within_deg;    // of the optical axis; empty: anywhere
  std::optional<double> diameter_deg;  // on black; empty: it fills the field
};

struct SceneInput {
  std::string file;
  optics::Scene scene;  // with the rendering constant of the file, if it has one
  bool has_rendering_constant = false;
  std::vector<std::string> material_names;
  std::vector<std::string> light_names;
  std::vector<std::string> patch_names;
  std::vector<optics::Patch> patches;  // in the file's order
  std::vector<PatchField> patch_fields;
  std::filesystem::path cube;  // empty: none
  std::optional<MixedReality> mixed_reality;
};

// Errors: NotFound; InvalidArgument naming file and line (not a scene) or file and field (a value
// that makes no sense, a name given twice or unknown, a shader of another pipeline with what it is
// called in this one, a patch that turns its back to the eye).
absl::StatusOr<SceneInput> ReadScene(const std::filesystem::path& file);
absl::StatusOr<SceneInput> ParseScene(const std::string& text, const std::filesystem::path& file);

// Parts of it, for ParseScene.
absl::StatusOr<optics::Material> ReadMaterial(const v1::SceneMaterial& material,
                                              optics::Renderer renderer, const std::string& where);
absl::StatusOr<optics::Light> ReadLight(const v1::SceneLight& light, const std::string& where);
absl::StatusOr<MixedReality> ReadPassThrough(const v1::PassThrough& pass_through,
                                             const std::string& where);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_SCENE_READ_SCENE_H_
