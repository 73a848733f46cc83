// Locations sorted by which of their levels are valid.
#ifndef EYEBOX_FIT_FIELD_MASK_GROUPS_H_
#define EYEBOX_FIT_FIELD_MASK_GROUPS_H_

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "fit/field/shared_exponent.h"

namespace eyebox::fit {

// Locations with one mask. All that a sum of squares needs of them is Y^T Y, so more locations than
// levels are replaced by the R of a QR decomposition: as many rows, the same products, and none of
// the digits that squaring would cost.
struct MaskGroup {
  std::vector<int> levels;       // the valid ones, ascending
  std::vector<size_t> members;   // locations
  Eigen::VectorXd root_weights;  // [valid levels], of the levels
  Eigen::VectorXd constant;      // root_weights scaled to length 1
  // [rows, valid levels]: sqrt(level weight location weight) times luminance, less its part along
  // `constant`; rows are locations or stand for them.
  Eigen::MatrixXd rows;
  double squares = 0;  // of all elements of `rows`
};

// Groups of at least 3 valid levels and weights above 0.
std::vector<MaskGroup> GroupByMask(const MaskedStack& stack, const FieldWeights& weights);

}  // namespace eyebox::fit

#endif  // EYEBOX_FIT_FIELD_MASK_GROUPS_H_
