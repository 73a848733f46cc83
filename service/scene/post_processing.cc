#include "service/scene/post_processing.h"

#include <array>
#include <memory>
#include <optional>
#include <utility>

#include "capture/base/status.h"
#include "fit/cube/table_file.h"

namespace eyebox::service {
namespace {

using optics::Renderer;

absl::StatusOr<PostProcessing> OfHdrp(const fit::HdrpModel& model,
                                      const std::filesystem::path& table) {
  std::optional<optics::ColourTable> cube;
  if (!table.empty()) {
    EYEBOX_ASSIGN_OR_RETURN(cube, ReadExternalTable(table));
  }
  EYEBOX_ASSIGN_OR_RETURN(const fit::HdrpRenderer renderer,
                          fit::HdrpRenderer::Create(model, cube ? &*cube : nullptr));
  PostProcessing post;
  post.stages = renderer.Stages();
  if (model.stores_lights_apart) {
    post.lights_apart = {optics::PackedFloatBuffer{optics::Rounding::kTruncate}};
  }
  return post;
}

}  // namespace

optics::Rgb PostProcessing::Stored(const optics::ShadedParts& parts) const {
  optics::Rgb sum = RunPipeline(lights_apart, parts.direct);
  const optics::Rgb ambient = RunPipeline(lights_apart, parts.ambient);
  for (size_t channel = 0; channel < 3; ++channel) sum[channel] += ambient[channel];
  return RunPipeline(stages, sum);
}

absl::StatusOr<PostProcessing> PostProcessingOf(Renderer renderer, const fit::HdrpModel& model,
                                                const std::filesystem::path& table) {
  if (renderer == Renderer::kHdrp) return OfHdrp(model, table);
  PostProcessing post;
  // Gamma mode computes with encoded colours throughout.
  if (renderer != Renderer::kBuiltInGamma) post.stages.emplace_back(optics::EncodeSrgb{});
  post.stages.emplace_back(optics::Saturate{});
  if (!table.empty()) {
    if (table.extension() == ".cube") {
      return BadInput(table.string(), "is a .cube, which is HDRP's External tonemapping",
                      "give the strip PNG of this pipeline: eyebox cube --target pps");
    }
    EYEBOX_ASSIGN_OR_RETURN(fit::Cube3d strip, fit::ReadStrip(table));
    post.stages.emplace_back(optics::UniformTable{std::make_shared<const optics::ColourTable>(
        optics::ColourTable{strip.size, std::move(strip.entries)})});
  }
  post.stages.emplace_back(optics::QuantiseTo8Bits{});
  return post;
}

absl::StatusOr<optics::ColourTable> ReadExternalTable(const std::filesystem::path& file) {
  EYEBOX_ASSIGN_OR_RETURN(fit::Cube3d cube, fit::ReadCube(file));
  const std::array<double, 3> zeros = {0, 0, 0};
  const std::array<double, 3> ones = {1, 1, 1};
  if (cube.domain_min != zeros || cube.domain_max != ones) {
    return BadInput(file.string(), "its domain is not 0 to 1, which HDRP would pass over",
                    "give a .cube made for HDRP");
  }
  return optics::ColourTable{cube.size, std::move(cube.entries)};
}

}  // namespace eyebox::service
