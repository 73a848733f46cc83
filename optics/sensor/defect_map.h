// Hot pixels, found in darks, and dead ones, found in even light.
#ifndef EYEBOX_OPTICS_SENSOR_DEFECT_MAP_H_
#define EYEBOX_OPTICS_SENSOR_DEFECT_MAP_H_

#include <cstdint>
#include <span>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "capture/base/image.h"
#include "optics/reduce/frame_stacker.h"

namespace eyebox::optics {

struct DefectOptions {
  // In robust standard deviations (1.4826 MAD, at least that of quantisation) above the median.
  double threshold = 8;
  int colour_period_px = 2;  // distance of same-colour neighbours; 2 suits a Bayer mosaic and grey
};

struct DefectMap {
  Image<uint8_t> defective;  // [height, width], 1 where defective
  double hot_share = 0;      // of all pixels
  double dead_share = 0;     // likewise, of those found by AddDeadPixels
  double median_dark_rate_dn_s = 0;
};

// A pixel is hot where the count of the longest dark, or its growth from the shortest dark to the
// longest, exceeds the median by the threshold; also where any dark is saturated.
// Errors: FailedPrecondition (no darks), InvalidArgument (sizes or gains differ).
absl::StatusOr<DefectMap> FindHotPixels(std::span<const Stack> darks,
                                        const DefectOptions& options = {});

// Adds to `map` the pixels whose signal under light, bright - dark, departs from the median of
// their 5 x 5 same-colour neighbourhood, relative to it, by more than the threshold on the scale of
// all pixels' departures: dead, dull or too sensitive. Uneven light does not matter. Pixels whose
// neighbourhood has no signal cannot be judged and are left as they are.
// Errors: InvalidArgument (sizes differ).
absl::Status AddDeadPixels(const Stack& bright, const Stack& dark, const DefectOptions& options,
                           DefectMap& map);

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_SENSOR_DEFECT_MAP_H_
