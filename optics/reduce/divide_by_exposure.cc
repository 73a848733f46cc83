#include "optics/reduce/divide_by_exposure.h"

#include "absl/strings/str_cat.h"
#include "capture/base/status.h"
#include "capture/base/vectorise.h"

namespace eyebox::optics {

EYEBOX_VECTORISE
void DividePixelsByExposure(double exposure_s, const MeasuredRow& counts_dn) {
  const auto per_s = static_cast<float>(1 / exposure_s);
  const float per_s_squared = per_s * per_s;
  float* const value = counts_dn.value.data();
  float* const variance = counts_dn.variance.data();
  const size_t count = counts_dn.size();
  for (size_t i = 0; i < count; ++i) {
    value[i] *= per_s;
    variance[i] *= per_s_squared;
  }
}

absl::StatusOr<MeasuredImage> DivideByExposure(MeasuredImage image_dn, double exposure_s) {
  if (!(exposure_s > 0)) {
    return BadInput("exposure", absl::StrCat(exposure_s, " s"), "state an exposure above 0 s");
  }
  if (image_dn.unit != "DN") {
    return BadInput("image", absl::StrCat("its unit is ", image_dn.unit),
                    "divide counts in DN by the exposure");
  }
  DividePixelsByExposure(exposure_s, PixelsOf(image_dn));
  image_dn.unit = "DN/s";
  image_dn.history.push_back(absl::StrCat("DivideByExposure(", exposure_s, " s)"));
  return image_dn;
}

}  // namespace eyebox::optics
