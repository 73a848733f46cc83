// The gamma, or gamma and v0, that serve all locations best.
#ifndef EYEBOX_FIT_FIELD_SHAPE_SEARCH_H_
#define EYEBOX_FIT_FIELD_SHAPE_SEARCH_H_

#include <array>
#include <span>
#include <vector>

#include "fit/field/mask_groups.h"

namespace eyebox::fit {

struct ShapeOptimum {
  double gamma = 0;
  double cutoff_drive = 0;
  // Second derivatives of half the sum of squares by (gamma, v0), without the terms that the
  // residuals bring (Kaufman's approximation).
  std::array<double, 4> curvature{};  // [2, 2]
  bool converged = false;
  int iterations = 0;
};

// A scan over the plane, then damped Gauss-Newton steps on the profile of the sum of squares
// (variable projection) until they no longer move gamma and v0. v0 stays within 0 and the third
// lowest drive from the top. All that a sum of squares needs of the locations of a group is Y^T Y,
// so more of them than levels are replaced by the R of a QR decomposition: as many rows, the same
// products, and none of the digits that squaring would cost.
ShapeOptimum SearchShape(const MaskedStack& stack, const FieldWeights& weights,
                         std::span<const MaskGroup> groups, const SharedExponentOptions& options);

}  // namespace eyebox::fit

#endif  // EYEBOX_FIT_FIELD_SHAPE_SEARCH_H_
