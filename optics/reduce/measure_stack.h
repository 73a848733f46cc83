// From a stack of counts to counts with a variance and a mask.
#ifndef EYEBOX_OPTICS_REDUCE_MEASURE_STACK_H_
#define EYEBOX_OPTICS_REDUCE_MEASURE_STACK_H_

#include <span>

#include "capture/base/image.h"
#include "optics/reduce/calibration.h"
#include "optics/reduce/expected_rate.h"
#include "optics/reduce/measured_image.h"
#include "optics/reduce/measured_row.h"

namespace eyebox::optics {

// DN, dark not yet subtracted. The variance is that of the noise model at the expected count, of as
// many frames as the pixel's mean holds.
// Masked are saturated, defective and railed pixels; railed means that the expected count, not the
// noisy one, is within `rail_guard_sigmas` of saturation or of 0 DN, where the clipped noise would
// shift the mean. `expected_rate` is in DN/s above the dark, [height, width].
MeasuredImage MeasureStack(const Exposure& exposure, const Image<float>& expected_rate_dn_s,
                           const NoiseModel& noise, const DefectMap& defects,
                           double rail_guard_sigmas);

// Row y of the light, its dark subtracted, as MeasureStack and SubtractDark give it, bit by bit.
// `expected_dn_s`: of that row.
void MeasureRowAboveDark(const Exposure& exposure, int y, std::span<const float> expected_dn_s,
                         const NoiseModel& noise, const DefectMap& defects,
                         double rail_guard_sigmas, const MeasuredRow& counts);

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_REDUCE_MEASURE_STACK_H_
