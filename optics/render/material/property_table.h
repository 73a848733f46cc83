// Which property of one of Unity's shaders stands for which of another.
#ifndef EYEBOX_OPTICS_RENDER_MATERIAL_PROPERTY_TABLE_H_
#define EYEBOX_OPTICS_RENDER_MATERIAL_PROPERTY_TABLE_H_

#include <optional>
#include <span>
#include <string_view>

namespace eyebox::optics {

enum class UnityShader { kStandard, kUrpLit, kHdrpLit };

// A row of Kyselka's table 4.2. Empty where there is no direct equivalent; `channel` is the colour
// channel of the HDRP map that holds what was a map of its own, or a blank.
struct PropertyRow {
  std::string_view standard;
  std::string_view urp_lit;
  std::string_view hdrp_lit;
  char hdrp_channel = ' ';
};

std::span<const PropertyRow> PropertyTable();

// The name in `to` of the property that `from` calls `name`, first match (HDRP's _MaskMap is
// several); nothing where it has no equivalent or is not in the table.
std::optional<std::string_view> TranslateProperty(std::string_view name, UnityShader from,
                                                  UnityShader to);

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_RENDER_MATERIAL_PROPERTY_TABLE_H_
