// Subtracts what the sensor reads without light.
#ifndef EYEBOX_OPTICS_REDUCE_SUBTRACT_DARK_H_
#define EYEBOX_OPTICS_REDUCE_SUBTRACT_DARK_H_

#include "absl/status/statusor.h"
#include "optics/reduce/calibration.h"
#include "optics/reduce/frame_stacker.h"
#include "optics/reduce/measured_image.h"

namespace eyebox::optics {

// light - dark, in DN. Negative values are kept: clipping them would bias the mean. Variances add.
// Errors: InvalidArgument (dark of another exposure, gain or size, or light not in DN).
absl::StatusOr<MeasuredImage> SubtractDark(MeasuredImage light_dn, const Setting& setting,
                                           const DarkFrame& dark);

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_REDUCE_SUBTRACT_DARK_H_
