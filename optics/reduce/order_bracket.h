// The exposures of a bracket checked, put in order and each turned into a rate.
#ifndef EYEBOX_OPTICS_REDUCE_ORDER_BRACKET_H_
#define EYEBOX_OPTICS_REDUCE_ORDER_BRACKET_H_

#include <span>
#include <vector>

#include "absl/status/statusor.h"
#include "optics/reduce/calibration.h"
#include "optics/reduce/expected_rate.h"
#include "optics/reduce/frame_stacker.h"
#include "optics/reduce/measured_image.h"
#include "optics/reduce/reduce_level.h"
#include "optics/reduce/rows.h"

namespace eyebox::optics {

// Ascending exposure, each with its dark, without saturation masks. Borrows from both arguments.
// Errors: those of ReduceRate.
absl::StatusOr<std::vector<Exposure>> OrderBracket(std::span<const Stack> stacks,
                                                   const Calibration& calibration);

// Fills in the saturation masks of those rows.
void MaskSaturation(Rows rows, const ReduceOptions& options, std::span<Exposure> bracket);

// Counts above the dark of one exposure, DN, masked, linearised where the calibration says how.
absl::StatusOr<MeasuredImage> CountsOf(const Exposure& exposure,
                                       const Image<float>& expected_rate_dn_s,
                                       const Calibration& calibration,
                                       const ReduceOptions& options);

// The same in DN/s.
absl::StatusOr<MeasuredImage> RateOf(const Exposure& exposure,
                                     const Image<float>& expected_rate_dn_s,
                                     const Calibration& calibration, const ReduceOptions& options);

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_REDUCE_ORDER_BRACKET_H_
