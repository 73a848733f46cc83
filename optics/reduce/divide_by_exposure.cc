#include "optics/reduce/divide_by_exposure.h"

#include "absl/strings/str_cat.h"
#include "capture/base/status.h"

namespace eyebox::optics {

absl::StatusOr<MeasuredImage> DivideByExposure(MeasuredImage image_dn, double exposure_s) {
  if (!(exposure_s > 0)) {
    return BadInput("exposure", absl::StrCat(exposure_s, " s"), "state an exposure above 0 s");
  }
  if (image_dn.unit != "DN") {
    return BadInput("image", absl::StrCat("its unit is ", image_dn.unit),
                    "divide counts in DN by the exposure");
  }
  const auto per_s = static_cast<float>(1 / exposure_s);
  const float per_s_squared = per_s * per_s;
  for (float& value : image_dn.value.pixels()) value *= per_s;
  for (float& variance : image_dn.variance.pixels()) variance *= per_s_squared;
  image_dn.unit = "DN/s";
  image_dn.history.push_back(absl::StrCat("DivideByExposure(", exposure_s, " s)"));
  return image_dn;
}

}  // namespace eyebox::optics
