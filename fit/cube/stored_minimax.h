// The design with the way to the display in the loop.
#ifndef EYEBOX_FIT_CUBE_STORED_MINIMAX_H_
#define EYEBOX_FIT_CUBE_STORED_MINIMAX_H_

#include <vector>

#include "absl/status/status.h"
#include "fit/base/activation.h"
#include "fit/cube/design_table.h"

namespace eyebox::fit {

// Errors: InvalidArgument (only HDRP has R11G11B10 buffers; a strip and a PTB table hold no half
// floats; a PTB table is not interpolated).
absl::Status CheckStorage(TableTarget target, const StorageModel& storage);

// [size] entries with the smallest worst error over x in [x_from, 1] after `storage`, one row for
// all channels. Truncation, weights and 8-bit output turn a bound on luminance into a bound on a
// mix of two entries exactly, so that the optimum is as exact as without them; half floats are
// rounded to afterwards, with bounds drawn in by that rounding. Where the bounds leave freedom, the
// entries stay at `preferred` [size].
std::vector<double> StoredMinimaxEntries(const Activation& activation, TableTarget target,
                                         double white_u, double x_from, const StorageModel& storage,
                                         std::vector<double> preferred);

}  // namespace eyebox::fit

#endif  // EYEBOX_FIT_CUBE_STORED_MINIMAX_H_
