// From counts to a rate.
#ifndef EYEBOX_OPTICS_REDUCE_DIVIDE_BY_EXPOSURE_H_
#define EYEBOX_OPTICS_REDUCE_DIVIDE_BY_EXPOSURE_H_

#include "absl/status/statusor.h"
#include "optics/reduce/measured_image.h"
#include "optics/reduce/measured_row.h"

namespace eyebox::optics {

// DN to DN/s. Errors: InvalidArgument (exposure not above 0, image not in DN).
absl::StatusOr<MeasuredImage> DivideByExposure(MeasuredImage image_dn, double exposure_s);
// The same of some pixels, which become a rate.
void DividePixelsByExposure(double exposure_s, const MeasuredRow& counts_dn);

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_REDUCE_DIVIDE_BY_EXPOSURE_H_
