// One rate from the exposures of a bracket.
#ifndef EYEBOX_OPTICS_REDUCE_MERGE_BRACKET_H_
#define EYEBOX_OPTICS_REDUCE_MERGE_BRACKET_H_

#include <span>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "optics/reduce/measured_image.h"
#include "optics/reduce/measured_row.h"

namespace eyebox::optics {

// Inverse-variance mean of the valid exposures of each pixel. A pixel without any carries the
// reasons of all exposures: kSaturated alone means all saturated, kUnderexposed alone all dark,
// both a gap in the bracket. Variances must come from an expectation (see expected_rate.h), or the
// mean is biased low. Memory: one image, whatever the number of exposures. Not thread-safe.
class BracketMerger {
 public:
  // Errors: InvalidArgument (size or unit differ from the first).
  absl::Status Add(const MeasuredImage& rate);
  // Leaves the merger empty. Errors: FailedPrecondition (nothing was added).
  absl::StatusOr<MeasuredImage> Finish();

 private:
  int exposures_ = 0;
  MeasuredImage sums_;  // value: sum of weight * rate; variance: sum of weights; mask: reasons
};

// The same for some pixels: `sums` begin as zeros, take each exposure in and become the mean.
void AddToMerge(const ConstMeasuredRow& rate, const MeasuredRow& sums);
void FinishMerge(const MeasuredRow& sums);

// The same for images that are all in memory. Errors: those of BracketMerger.
absl::StatusOr<MeasuredImage> MergeBracket(std::span<const MeasuredImage> rates);

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_REDUCE_MERGE_BRACKET_H_
