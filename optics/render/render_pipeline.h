// A pipeline as a list of stages.
#ifndef EYEBOX_OPTICS_RENDER_RENDER_PIPELINE_H_
#define EYEBOX_OPTICS_RENDER_RENDER_PIPELINE_H_

#include <span>
#include <string_view>
#include <variant>
#include <vector>

#include "optics/render/stages.h"

namespace eyebox::optics {

using Stage =
    std::variant<EncodeSrgb, DecodeSrgb, Exposure, PackedFloatBuffer, HalfFloatBuffer, SrgbBuffer,
                 QuantiseTo8Bits, DitherMean, Saturate, LogCTable, KnotTable, UniformTable>;
using RenderPipeline = std::vector<Stage>;

// The colour that leaves the last stage.
Rgb RunPipeline(std::span<const Stage> stages, const Rgb& colour);

// "R11G11B10, truncated", "sRGB encoding", ...: for reports.
std::string_view NameOf(const Stage& stage);

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_RENDER_RENDER_PIPELINE_H_
