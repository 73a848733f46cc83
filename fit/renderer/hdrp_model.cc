#include "fit/renderer/hdrp_model.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <numbers>
#include <utility>
#include <variant>

#include "absl/strings/str_format.h"
#include "capture/base/status.h"
#include "fit/renderer/known_knots.h"
#include "optics/render/grading_table.h"
#include "optics/render/srgb.h"

namespace eyebox::fit {
namespace {

using optics::Rgb;
using optics::Stage;

std::vector<Stage> BufferStage(ColorBuffer buffer) {
  switch (buffer) {
    case ColorBuffer::kExact:
      return {};
    case ColorBuffer::kPackedTruncated:
      return {optics::PackedFloatBuffer{optics::Rounding::kTruncate}};
    case ColorBuffer::kPackedRounded:
      return {optics::PackedFloatBuffer{optics::Rounding::kNearestEven}};
    case ColorBuffer::kHalf:
      return {optics::HalfFloatBuffer{}};
  }
  return {};
}

absl::Status CheckCube(const HdrpModel& model, const optics::ColourTable& cube) {
  const auto size = static_cast<size_t>(std::max(cube.size, 0));
  if (cube.size < 2 || cube.size > 129 || cube.entries.size() != size * size * size) {
    return BadInput("cube",
                    absl::StrFormat("%d entries an axis, %d in all", cube.size,
                                    static_cast<int>(cube.entries.size())),
                    "give 2 to 129 an axis and as many entries as its cube");
  }
  if (model.axis == TableAxis::kPublishedKnots && cube.size != kPublishedSize) {
    return BadInput("cube", absl::StrFormat("%d entries an axis", cube.size),
                    "the published knots exist for 32 only; choose the model in LogC");
  }
  return absl::OkStatus();
}

// The first two entries never matter; any ascending u below the third will do.
std::vector<double> KnotsOf32() {
  std::vector<double> knots = {-2, -1};
  knots.insert(knots.end(), KnotsFromOptimisation().begin(), KnotsFromOptimisation().end());
  return knots;
}

}  // namespace

HdrpModel HdrpModel::Published() {
  return {.light_scale = 0.822,
          .reflectance_floor = 0,
          .stores_lights_apart = false,
          .dither_mean_levels = 0,
          .buffer = ColorBuffer::kExact,
          .axis = TableAxis::kPublishedKnots,
          .grading_through_hsv = false,
          .half_float_table = false};
}

absl::StatusOr<HdrpRenderer> HdrpRenderer::Create(const HdrpModel& model,
                                                  const optics::ColourTable* cube) {
  if (cube != nullptr) EYEBOX_RETURN_IF_ERROR(CheckCube(model, *cube));
  HdrpRenderer renderer;
  renderer.model_ = model;
  renderer.buffer_ = BufferStage(model.buffer);
  optics::RenderPipeline& stages = renderer.stages_;
  stages = renderer.buffer_;
  if (model.axis == TableAxis::kLogC) {
    const optics::GradingOptions options{model.grading_through_hsv, model.half_float_table};
    const int size = cube == nullptr ? kPublishedSize : cube->size;
    stages.emplace_back(optics::LogCTable{
        std::make_shared<const optics::ColourTable>(optics::GradingTable(size, cube, options))});
  } else if (cube != nullptr) {
    stages.emplace_back(
        optics::KnotTable{std::make_shared<const optics::ColourTable>(*cube), KnotsOf32()});
  }
  stages.insert(stages.end(), renderer.buffer_.begin(), renderer.buffer_.end());
  stages.emplace_back(optics::EncodeSrgb{});
  stages.emplace_back(optics::DitherMean{model.dither_mean_levels});
  stages.emplace_back(optics::Saturate{});
  return renderer;
}

void HdrpRenderer::SetParameters(double light_scale, double reflectance_floor,
                                 double dither_mean_levels) {
  model_.light_scale = light_scale;
  model_.reflectance_floor = reflectance_floor;
  model_.dither_mean_levels = dither_mean_levels;
  for (Stage& stage : stages_) {
    if (auto* dither = std::get_if<optics::DitherMean>(&stage)) dither->levels = dither_mean_levels;
  }
}

Rgb HdrpRenderer::Stored(const Rgb& color) const {
  return model_.stores_lights_apart ? optics::RunPipeline(buffer_, color) : color;
}

Rgb HdrpRenderer::Shade(const SceneRow& row) const {
  const double exposed = std::exp2(-row.exposure_stops);
  const double directional = row.directional_intensity * row.facing / std::numbers::pi;
  Rgb from_directional{};
  Rgb from_ambient{};
  for (size_t channel = 0; channel < 3; ++channel) {
    const double reflectance =
        exposed * (model_.light_scale * optics::SrgbToLinear(row.material[channel]) +
                   model_.reflectance_floor);
    if (directional > 0) {
      from_directional[channel] =
          reflectance * directional * optics::SrgbToLinear(row.directional_color[channel]);
    }
    from_ambient[channel] = reflectance * row.ambient_intensity * row.ambient_color[channel];
  }
  from_directional = Stored(from_directional);
  from_ambient = Stored(from_ambient);
  return {from_directional[0] + from_ambient[0], from_directional[1] + from_ambient[1],
          from_directional[2] + from_ambient[2]};
}

RowPrediction HdrpRenderer::Predict(const SceneRow& row, RowMaterial material) const {
  RowPrediction prediction;
  prediction.unprocessed =
      material == RowMaterial::kUnlit ? optics::DecodeSrgb{}.Apply(row.material) : Shade(row);
  prediction.stored = optics::RunPipeline(stages_, prediction.unprocessed);
  return prediction;
}

std::vector<std::string> HdrpRenderer::Terms(const std::vector<SceneRow>& rows,
                                             RowMaterial material) const {
  std::vector<std::string> terms = {"material"};
  if (material == RowMaterial::kUnlit) return terms;
  const auto any = [&rows](auto test) { return std::any_of(rows.begin(), rows.end(), test); };
  if (any([](const SceneRow& row) { return row.directional_intensity * row.facing > 0; })) {
    terms.emplace_back("directional light");
  }
  if (any([](const SceneRow& row) { return row.ambient_intensity > 0; })) {
    terms.emplace_back("ambient light");
  }
  if (any([](const SceneRow& row) { return row.exposure_stops != 0; })) {
    terms.emplace_back("exposure");
  }
  return terms;
}

}  // namespace eyebox::fit
