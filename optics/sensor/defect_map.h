// Hot pixels, found in darks.
#ifndef EYEBOX_OPTICS_SENSOR_DEFECT_MAP_H_
#define EYEBOX_OPTICS_SENSOR_DEFECT_MAP_H_

#include <cstdint>
#include <span>

#include "absl/status/statusor.h"
#include "capture/base/image.h"
#include "optics/reduce/frame_stacker.h"

namespace eyebox::optics {

struct DefectOptions {
  // In robust standard deviations (1.4826 MAD, at least that of quantisation) above the median.
  double threshold = 8;
};

struct DefectMap {
  Image<uint8_t> defective;  // [height, width], 1 where defective
  double hot_share = 0;      // of all pixels
  double median_dark_rate_dn_s = 0;
};

// A pixel is hot where the count of the longest dark, or its growth from the shortest dark to the
// longest, exceeds the median by the threshold; also where any dark is saturated.
// Errors: FailedPrecondition (no darks), InvalidArgument (sizes or gains differ).
absl::StatusOr<DefectMap> FindHotPixels(std::span<const Stack> darks,
                                        const DefectOptions& options = {});

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_SENSOR_DEFECT_MAP_H_
