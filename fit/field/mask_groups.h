// Locations sorted by which of their levels are valid.
#ifndef EYEBOX_FIT_FIELD_MASK_GROUPS_H_
#define EYEBOX_FIT_FIELD_MASK_GROUPS_H_

#include <cstddef>
#include <vector>

#include "fit/field/shared_exponent.h"

namespace eyebox::fit {

struct MaskGroup {
  std::vector<int> levels;      // the valid ones, ascending
  std::vector<size_t> members;  // locations
};

// Groups of at least 3 valid levels and weights above 0.
std::vector<MaskGroup> GroupByMask(const MaskedStack& stack, const FieldWeights& weights);

}  // namespace eyebox::fit

#endif  // EYEBOX_FIT_FIELD_MASK_GROUPS_H_
