// The mean of repeated measurements of the same thing.
#ifndef EYEBOX_OPTICS_REDUCE_AVERAGE_REPEATS_H_
#define EYEBOX_OPTICS_REDUCE_AVERAGE_REPEATS_H_

#include <span>

#include "absl/status/statusor.h"
#include "optics/reduce/measured_image.h"

namespace eyebox::optics {

struct AverageOptions {
  // With three or more valid repeats, those further from their median than this many standard
  // deviations of one repeat are left out.
  double clip_sigmas = 5;
};

// Per pixel the unweighted mean of the valid repeats, variance = sum(variance) / n^2. A pixel
// without any carries the reasons of all repeats.
// Errors: InvalidArgument (none, sizes or units differ).
absl::StatusOr<MeasuredImage> AverageRepeats(std::span<const MeasuredImage> repeats,
                                             const AverageOptions& options = {});

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_REDUCE_AVERAGE_REPEATS_H_
