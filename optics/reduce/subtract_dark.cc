#include "optics/reduce/subtract_dark.h"

#include "absl/strings/str_cat.h"
#include "capture/base/status.h"
#include "capture/base/vectorise.h"

namespace eyebox::optics {
namespace {

EYEBOX_VECTORISE
void SubtractPixels(const MeasuredImage& dark, MeasuredImage& light) {
  float* const value = light.value.pixels().data();
  float* const variance = light.variance.pixels().data();
  uint8_t* const mask = light.mask.pixels().data();
  const float* const dark_value = dark.value.pixels().data();
  const float* const dark_variance = dark.variance.pixels().data();
  const uint8_t* const dark_mask = dark.mask.pixels().data();
  const size_t count = light.mask.pixels().size();
  for (size_t i = 0; i < count; ++i) {
    value[i] -= dark_value[i];  // NaN where the dark is masked
    variance[i] += dark_variance[i];
    mask[i] = static_cast<uint8_t>(mask[i] | dark_mask[i]);
  }
}

}  // namespace

absl::StatusOr<MeasuredImage> SubtractDark(MeasuredImage light_dn, const Setting& setting,
                                           const DarkFrame& dark) {
  const std::string where = absl::StrCat("light of ", Describe(setting));
  if (!SameSetting(setting, dark.setting)) {
    return BadInput(where, absl::StrCat("the dark is of ", Describe(dark.setting)),
                    "subtract a dark of the same exposure and gain");
  }
  if (light_dn.size() != dark.image_dn.size()) {
    return BadInput(where, "the dark has another size", "record both with one region of interest");
  }
  if (light_dn.unit != "DN") {
    return BadInput(where, absl::StrCat("its unit is ", light_dn.unit), "subtract darks from DN");
  }
  SubtractPixels(dark.image_dn, light_dn);
  for (const std::string& step : dark.image_dn.history) {
    const bool made = step.starts_with("InterpolateDark(") || step.starts_with("MatchDark(");
    if (made) light_dn.history.push_back(step);
  }
  light_dn.history.push_back(absl::StrCat("SubtractDark(", Describe(dark.setting), ")"));
  return light_dn;
}

}  // namespace eyebox::optics
