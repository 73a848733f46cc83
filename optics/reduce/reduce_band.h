// The reduction of some rows of a bracket. A whole image at once would go through the memory for
// every step; a row stays near the processor, and bands of rows are independent of each other.
#ifndef EYEBOX_OPTICS_REDUCE_REDUCE_BAND_H_
#define EYEBOX_OPTICS_REDUCE_REDUCE_BAND_H_

#include <span>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "optics/reduce/calibration.h"
#include "optics/reduce/compare_exposures.h"
#include "optics/reduce/expected_rate.h"
#include "optics/reduce/measured_image.h"
#include "optics/reduce/reduce_level.h"
#include "optics/reduce/rows.h"
#include "optics/reduce/variance_budget.h"

namespace eyebox::optics {

struct PixelCounts {
  size_t saturated = 0;  // before dilation
  size_t underexposed = 0;
  size_t valid = 0;
};

struct BandSums {
  std::vector<PixelCounts> exposures;  // as the bracket
  std::vector<PairSums> pairs;         // of neighbours in the bracket
};

// Expected rate, then for each exposure: mask, dark, linearity, rate, merge. Writes `rows` of
// `merged` (value, variance and mask) and no others. The pixels are those that the steps give on
// the whole image, bit by bit. A bracket that HistoryOf() takes does not fail.
BandSums ReduceBand(std::span<const Exposure> bracket, const Calibration& calibration,
                    const ReduceOptions& options, Rows rows, MeasuredImage& merged,
                    VarianceBudgetMeter& budget);

// What the steps write down about themselves, from taking them on no pixel at all. Errors: those
// of the steps.
absl::StatusOr<std::vector<std::string>> HistoryOf(std::span<const Exposure> bracket,
                                                   const Calibration& calibration,
                                                   const ReduceOptions& options);

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_REDUCE_REDUCE_BAND_H_
