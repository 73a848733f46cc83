#include "service/scene/render_rows.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "absl/strings/str_cat.h"
#include "capture/base/status.h"
#include "service/scene/post_processing.h"

namespace eyebox::service {
namespace {

using fit::RowMaterial;
using fit::SceneRow;
using optics::Renderer;

void NameStages(const optics::RenderPipeline& stages, RowRendering& rendering) {
  for (const optics::Stage& stage : stages) {
    rendering.stages.emplace_back(optics::NameOf(stage));
  }
}

absl::StatusOr<RowRendering> RenderInHdrp(const std::vector<SceneRow>& rows, RowMaterial material,
                                          const RowRenderer& with) {
  std::optional<optics::ColourTable> cube;
  RowRendering rendering;
  if (!with.table.empty()) {
    EYEBOX_ASSIGN_OR_RETURN(cube, ReadExternalTable(with.table));
    rendering.table_size = cube->size;
  }
  EYEBOX_ASSIGN_OR_RETURN(const fit::HdrpRenderer renderer,
                          fit::HdrpRenderer::Create(with.model, cube ? &*cube : nullptr));
  rendering.predictions.reserve(rows.size());
  for (const SceneRow& row : rows) {
    rendering.predictions.push_back(renderer.Predict(row, material));
  }
  rendering.terms = renderer.Terms(rows, material);
  NameStages(renderer.Stages(), rendering);
  return rendering;
}

// Only the angle between normal and light counts for these materials.
optics::Scene SceneOf(const SceneRow& row, RowMaterial material, Renderer renderer) {
  optics::Scene scene;
  scene.settings.renderer = renderer;
  scene.settings.rendering_constant = 1;
  if (material == RowMaterial::kUnlit) {
    scene.materials = {optics::Unlit{row.material}};
    return scene;
  }
  scene.materials = {optics::LitMaterial(optics::Lambert{row.material})};
  const double sine = std::sqrt(std::max(1 - row.facing * row.facing, 0.0));
  scene.lights = {optics::DirectionalLight{
                      row.directional_color, row.directional_intensity, {sine, 0, -row.facing}},
                  optics::AmbientLight{row.ambient_color, row.ambient_intensity}};
  return scene;
}

absl::Status CheckExposures(const std::vector<SceneRow>& rows, Renderer renderer,
                            const std::filesystem::path& file) {
  for (size_t row = 0; row < rows.size(); ++row) {
    if (rows[row].exposure_stops == 0) continue;
    return BadInput(absl::StrCat(file.string(), " row ", row + 1, ", column e"),
                    absl::StrCat(std::string(optics::NameOf(renderer)), " has no exposure"),
                    "give 0 or choose --pipeline hdrp");
  }
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<RowRendering> RenderRows(const std::vector<SceneRow>& rows, RowMaterial material,
                                        const RowRenderer& with,
                                        const std::filesystem::path& file) {
  if (with.renderer == Renderer::kHdrp) return RenderInHdrp(rows, material, with);
  EYEBOX_RETURN_IF_ERROR(CheckExposures(rows, with.renderer, file));
  EYEBOX_ASSIGN_OR_RETURN(const PostProcessing post,
                          PostProcessingOf(with.renderer, with.model, with.table));
  RowRendering rendering;
  bool direct = false;
  bool ambient = false;
  for (const SceneRow& row : rows) {
    const optics::Scene scene = SceneOf(row, material, with.renderer);
    const optics::PreparedScene prepared = Prepare(scene);
    const optics::ShadedParts parts = ShadeParts(prepared, {});
    fit::RowPrediction& prediction = rendering.predictions.emplace_back();
    for (size_t c = 0; c < 3; ++c) prediction.unprocessed[c] = parts.direct[c] + parts.ambient[c];
    prediction.stored = post.Stored(parts);
    const optics::TermsUsed used = ExplainShading(scene, prepared, {});
    ambient = ambient || used.ambient;
    direct = direct || (!used.lights.empty() && used.lights[0] == optics::LightUse::kShaded);
  }
  rendering.terms = {"material"};
  if (direct) rendering.terms.emplace_back("directional light");
  if (ambient) rendering.terms.emplace_back("ambient light");
  NameStages(post.stages, rendering);
  return rendering;
}

}  // namespace eyebox::service
