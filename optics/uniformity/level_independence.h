// Is g the same at all levels? That is what makes a full-field reading proportional to the patch's
// own luminance (Murray, Patel & Wiedenmann 2022, eq 9): tested here, not assumed.
#ifndef EYEBOX_OPTICS_UNIFORMITY_LEVEL_INDEPENDENCE_H_
#define EYEBOX_OPTICS_UNIFORMITY_LEVEL_INDEPENDENCE_H_

#include <cstddef>
#include <vector>

#include "absl/status/statusor.h"
#include "capture/base/image.h"
#include "optics/reduce/measured_image.h"

namespace eyebox::optics {

// A full field at one level, in blocks of pixels (see Binned). `variance` counts what differs from
// level to level: the flat's error is common to all and belongs to g.
struct LevelBlocks {
  double drive = 0;
  MeasuredImage blocks;
};

struct LevelAgainstShared {
  double drive = 0;
  double luminance = 0;        // a of this level, where g has a mean of 1
  double chi2 = 0;             // over the blocks
  double excess_relative = 0;  // rms of measured / (a g) - 1, noise taken off; 0 if noise is all
};

struct LevelIndependence {
  double chi2 = 0;
  double degrees_of_freedom = 0;  // (levels - 1) (blocks - 1)
  double p_value = 1;             // chance of such a chi2 if g were the same at all levels
  size_t blocks = 0;              // valid at every level
  std::vector<LevelAgainstShared> levels;
  Image<float> block_p_value;  // of each block alone, levels - 1 degrees of freedom; NaN if masked
  Image<float> g;              // shared, mean 1 over the blocks; NaN if masked
  double failing_share = 0;    // blocks whose own p-value is below 0.05
};

// Fits luminance = a_level g_block by weighted least squares, alternating until chi2 stays.
// Errors: InvalidArgument (sizes differ), FailedPrecondition (fewer than 2 levels that are lit, or
// fewer than 2 blocks valid at all of them).
absl::StatusOr<LevelIndependence> TestLevelIndependence(const std::vector<LevelBlocks>& levels);

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_UNIFORMITY_LEVEL_INDEPENDENCE_H_
