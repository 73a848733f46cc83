#include "optics/render/material/property_table.h"

#include <array>

namespace eyebox::optics {
namespace {

constexpr std::array kRows = {
    PropertyRow{"_Color", "_BaseColor", "_BaseColor"},
    PropertyRow{"_MainTex", "_BaseMap", "_BaseColorMap"},
    PropertyRow{"_Cutoff", "_Cutoff", "_AlphaCutoff"},
    PropertyRow{"_Glossiness", "_Smoothness", "_Smoothness"},
    PropertyRow{"_Metallic", "_Metallic", "_Metallic"},
    PropertyRow{"_MetallicGlossMap", "_MetallicGlossMap", "_MaskMap", 'R'},
    PropertyRow{"_BumpScale", "_BumpScale", "_NormalScale"},
    PropertyRow{"_BumpMap", "_BumpMap", "_NormalMap"},
    PropertyRow{"_Parallax", "_Parallax", ""},
    PropertyRow{"_ParallaxMap", "_ParallaxMap", "_HeightMap"},
    PropertyRow{"_OcclusionStrength", "_OcclusionStrength", ""},
    PropertyRow{"_OcclusionMap", "_OcclusionMap", "_MaskMap", 'G'},
    PropertyRow{"_EmissionColor", "_EmissionColor", "_EmissiveColor"},
    PropertyRow{"_Mode", "_Surface", "_SurfaceType"},
};

std::string_view NameIn(const PropertyRow& row, UnityShader shader) {
  switch (shader) {
    case UnityShader::kStandard:
      return row.standard;
    case UnityShader::kUrpLit:
      return row.urp_lit;
    case UnityShader::kHdrpLit:
      return row.hdrp_lit;
  }
  return {};
}

}  // namespace

std::span<const PropertyRow> PropertyTable() { return kRows; }

std::optional<std::string_view> TranslateProperty(std::string_view name, UnityShader from,
                                                  UnityShader to) {
  for (const PropertyRow& row : kRows) {
    if (name.empty() || NameIn(row, from) != name) continue;
    const std::string_view translated = NameIn(row, to);
    if (translated.empty()) return std::nullopt;
    return translated;
  }
  return std::nullopt;
}

}  // namespace eyebox::optics
