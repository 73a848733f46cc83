// What the exposures of one scene say of the sensor's linearity, count by count.
#ifndef EYEBOX_OPTICS_REDUCE_MEASURE_EXPOSURE_PAIRS_H_
#define EYEBOX_OPTICS_REDUCE_MEASURE_EXPOSURE_PAIRS_H_

#include <cstdint>
#include <span>
#include <vector>

#include "absl/status/statusor.h"
#include "capture/base/image.h"
#include "optics/reduce/linearise.h"
#include "optics/reduce/reduce_level.h"

namespace eyebox::optics {

// 1 where one of the 8 neighbours has more than twice the rate: under narrow-band light the colours
// of a mosaic that hardly answer read crosstalk of the one that does, which is not a function of
// their own count. [height, width].
Image<uint8_t> OutshonePixels(const Image<float>& expected_rate_dn_s);

// Neighbouring exposures of constant light: for each eighth of an octave of the expected rate, the
// mean counts above the dark of the pixels valid in both, where at least 100 are. The light's rate,
// not the count, decides which pixels are taken together, so that their noise cancels. Pixels next
// to a saturated one of any colour are left out: their crosstalk is cut off; so are pixels that a
// neighbour outshines. The calibration's own linearity is not applied.
// Errors: those of ReduceRate.
absl::StatusOr<std::vector<LinearityPair>> MeasureExposurePairs(std::span<const Stack> exposures,
                                                                const Calibration& calibration,
                                                                const ReduceOptions& options = {});

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_REDUCE_MEASURE_EXPOSURE_PAIRS_H_
