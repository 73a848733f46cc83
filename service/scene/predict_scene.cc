#include "service/scene/predict_scene.h"

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "capture/base/status.h"
#include "fit/renderer/hdrp_model.h"
#include "service/display.h"
#include "service/results/parameter.h"
#include "service/scene/post_processing.h"
#include "service/scene/read_scene.h"

namespace eyebox::service {
namespace {

using optics::LightUse;
using optics::Renderer;
using optics::Rgb;

void AddAnswer(const Display& display, const Rgb& v, v1::PatchPrediction& patch) {
  const std::vector<v1::Parameter> answer = display.Answer(v);
  if (answer.empty()) {
    patch.add_left_out("luminance: the drive is coloured and the activation is that of grey");
  } else if (answer.size() == 1) {
    *patch.mutable_luminance() = answer.front();
  } else {
    patch.mutable_tristimulus()->Add(answer.begin(), answer.end());
  }
}

void AddTerms(const SceneInput& input, const optics::TermsUsed& used, v1::PatchPrediction& patch) {
  if (used.lobes.diffuse) patch.add_evaluated("diffuse");
  if (used.lobes.specular) patch.add_evaluated("specular");
  if (used.view) patch.add_evaluated("direction of the eye");
  for (size_t i = 0; i < used.lights.size(); ++i) {
    const std::string light = absl::StrCat("light ", input.light_names[i]);
    if (used.lights[i] == LightUse::kShaded) {
      patch.add_evaluated(light);
    } else {
      patch.add_left_out(absl::StrCat(light, ": ", std::string(NameOf(used.lights[i]))));
    }
  }
}

void AddBalanced(const MixedReality& mixed, const Rgb& v, v1::PatchPrediction& patch) {
  const double top = std::exp2(mixed.bits) - 1;
  const Rgb code = {top * v[0], top * v[1], top * v[2]};
  const Rgb balanced = optics::BalanceWhite(code, mixed.balance, mixed.bits);
  patch.mutable_balanced_code()->Add(balanced.begin(), balanced.end());
}

class Predictor {
 public:
  Predictor(const SceneInput& input, const PostProcessing& post, const Display* display)
      : input_(input), prepared_(Prepare(input.scene)), post_(post), display_(display) {}

  void Patch(size_t index, v1::ScenePrediction& result) {
    const optics::Patch& patch = input_.patches[index];
    v1::PatchPrediction& predicted = *result.add_patches();
    predicted.set_name(input_.patch_names[index]);
    predicted.set_material(input_.material_names[patch.material]);
    const optics::ShadedParts parts = ShadeParts(prepared_, patch);
    const Rgb u = {parts.direct[0] + parts.ambient[0], parts.direct[1] + parts.ambient[1],
                   parts.direct[2] + parts.ambient[2]};
    const Rgb v = post_.Stored(parts);
    predicted.mutable_u()->Add(u.begin(), u.end());
    predicted.mutable_v()->Add(v.begin(), v.end());
    const optics::TermsUsed used = ExplainShading(input_.scene, prepared_, patch);
    predicted.add_evaluated("material colour");
    AddTerms(input_, used, predicted);
    if (display_ != nullptr) AddAnswer(*display_, v, predicted);
    if (input_.mixed_reality) AddBalanced(*input_.mixed_reality, v, predicted);
    needed_.resize(used.lights.size());
    for (size_t i = 0; i < used.lights.size(); ++i) {
      needed_[i] = needed_[i] || used.lights[i] == LightUse::kShaded;
    }
  }

  void UnusedLights(v1::ScenePrediction& result) const {
    for (size_t i = 0; i < needed_.size(); ++i) {
      if (!needed_[i]) result.add_unused_lights(input_.light_names[i]);
    }
  }

 private:
  const SceneInput& input_;
  optics::PreparedScene prepared_;
  const PostProcessing& post_;
  const Display* display_;
  std::vector<bool> needed_;
};

void Describe(const SceneInput& input, const PostProcessing& post, v1::ScenePrediction& result) {
  const optics::RendererSettings& settings = input.scene.settings;
  result.set_renderer(std::string(NameOf(settings.renderer)));
  for (const optics::Stage& stage : post.stages) {
    result.add_post_processing(std::string(NameOf(stage)));
  }
  if (settings.renderer != Renderer::kHdrp) return;
  auto& parameters = *result.mutable_parameters();
  AddParameter(parameters, "exposure", settings.exposure_ev, 0, "EV");
  AddParameter(parameters, "rendering_constant", settings.rendering_constant, 0, "1");
  if (!input.mixed_reality) return;
  AddParameter(parameters, "saturating_luminance", SaturatingLuminance(input.mixed_reality->camera),
               0, "cd/m2");
  AddParameter(parameters, "matching_exposure",
               MatchingExposure(input.mixed_reality->camera, settings.rendering_constant), 0, "EV");
}

void Settle(const fit::HdrpModel& model, SceneInput& input) {
  optics::RendererSettings& settings = input.scene.settings;
  if (settings.renderer != Renderer::kHdrp) return;
  if (!input.has_rendering_constant) settings.rendering_constant = model.light_scale;
  settings.reflectance_floor = model.reflectance_floor;
  if (input.mixed_reality && input.mixed_reality->match_exposure) {
    settings.exposure_ev =
        MatchingExposure(input.mixed_reality->camera, settings.rendering_constant);
  }
}

}  // namespace

absl::StatusOr<v1::ScenePrediction> PredictScene(const SceneRequest& request) {
  EYEBOX_ASSIGN_OR_RETURN(SceneInput input, ReadScene(request.scene));
  fit::HdrpModel model;
  // The mean of the dither belongs to one pixel of the captures that it was measured in.
  model.dither_mean_levels = 0;
  Settle(model, input);
  EYEBOX_ASSIGN_OR_RETURN(const PostProcessing post,
                          PostProcessingOf(input.scene.settings.renderer, model, input.cube));
  std::optional<Display> display;
  if (!request.activation.empty()) {
    EYEBOX_ASSIGN_OR_RETURN(display, Display::Read(request.activation));
  }
  v1::ScenePrediction result;
  Describe(input, post, result);
  Predictor predictor(input, post, display ? &*display : nullptr);
  for (size_t i = 0; i < input.patches.size(); ++i) predictor.Patch(i, result);
  predictor.UnusedLights(result);
  if (display) {
    result.set_activation_source(request.activation.string());
    result.add_warnings(
        "sigma of a luminance is that of the activation; what the renderer model "
        "leaves, about half a level of 255, is not in it");
  }
  return result;
}

}  // namespace eyebox::service
