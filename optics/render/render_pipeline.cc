#include "optics/render/render_pipeline.h"

namespace eyebox::optics {
namespace {

struct StageName {
  std::string_view operator()(const EncodeSrgb&) const { return "sRGB encoding"; }
  std::string_view operator()(const DecodeSrgb&) const { return "sRGB decoding"; }
  std::string_view operator()(const Exposure&) const { return "exposure"; }
  std::string_view operator()(const PackedFloatBuffer& buffer) const {
    return buffer.rounding == Rounding::kTruncate ? "R11G11B10, truncated" : "R11G11B10, rounded";
  }
  std::string_view operator()(const HalfFloatBuffer& buffer) const {
    return buffer.rounding == Rounding::kTruncate ? "R16G16B16A16, truncated"
                                                  : "R16G16B16A16, rounded";
  }
  std::string_view operator()(const SrgbBuffer&) const { return "8-bit sRGB buffer"; }
  std::string_view operator()(const QuantiseTo8Bits&) const { return "rounding to 8 bits"; }
  std::string_view operator()(const DitherMean&) const { return "mean of the dither"; }
  std::string_view operator()(const Saturate&) const { return "clamp to 0..1"; }
  std::string_view operator()(const LogCTable&) const { return "table in LogC"; }
  std::string_view operator()(const KnotTable&) const { return "table linear in u"; }
  std::string_view operator()(const UniformTable&) const { return "uniform table"; }
};

}  // namespace

Rgb RunPipeline(std::span<const Stage> stages, const Rgb& colour) {
  Rgb current = colour;
  for (const Stage& stage : stages) {
    current = std::visit([&current](const auto& step) { return step.Apply(current); }, stage);
  }
  return current;
}

std::string_view NameOf(const Stage& stage) { return std::visit(StageName{}, stage); }

}  // namespace eyebox::optics
