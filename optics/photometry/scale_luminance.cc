#include "optics/photometry/scale_luminance.h"

#include <utility>

#include "absl/strings/str_cat.h"
#include "capture/base/parallel.h"
#include "capture/base/status.h"

namespace eyebox::optics {
namespace {

absl::Status CheckLuminance(const KnownLuminance& known) {
  if (!(known.luminance_cd_m2 > 0)) {
    return BadInput("known luminance", absl::StrCat(known.luminance_cd_m2, " cd/m2"),
                    "give a luminance above 0");
  }
  if (!(known.relative_sigma >= 0 && known.relative_sigma < 1)) {
    return BadInput("known luminance", absl::StrCat("relative sigma ", known.relative_sigma),
                    "give its relative standard uncertainty, at least 0 and below 1");
  }
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<LuminanceImage> ScaleLuminance(MeasuredImage image, bool flat_corrected,
                                              const std::optional<KnownLuminance>& per_unit) {
  LuminanceImage luminance;
  luminance.flat_corrected = flat_corrected;
  luminance.image = std::move(image);
  if (!per_unit.has_value()) {
    luminance.image.unit = "relative";
    luminance.image.history.push_back("ScaleLuminance(no known luminance: relative)");
    return luminance;
  }
  EYEBOX_RETURN_IF_ERROR(CheckLuminance(*per_unit));
  const auto scale = static_cast<float>(per_unit->luminance_cd_m2);
  const float scale_squared = scale * scale;
  const auto value = luminance.image.value.pixels();
  const auto variance = luminance.image.variance.pixels();
  ForEachPieceInParallel(value.size(), [&](size_t first, size_t end) {
    for (size_t i = first; i < end; ++i) value[i] *= scale;
    for (size_t i = first; i < end; ++i) variance[i] *= scale_squared;
  });
  luminance.image.unit = "cd/m2";
  luminance.image.history.push_back(absl::StrCat("ScaleLuminance(", per_unit->luminance_cd_m2,
                                                 " cd/m2 per unit, relative sigma ",
                                                 per_unit->relative_sigma, ")"));
  luminance.absolute = true;
  luminance.scale_relative_sigma = per_unit->relative_sigma;
  return luminance;
}

}  // namespace eyebox::optics
