// A field stack, block by block, as the kernels take it.
#ifndef EYEBOX_FIT_FIELD_STACK_BLOCKS_H_
#define EYEBOX_FIT_FIELD_STACK_BLOCKS_H_

#include <cstddef>
#include <cstdint>
#include <vector>

#include "fit/field/common_exponent.h"
#include "fit/field/kernels.h"

namespace eyebox::fit {

// Loads that straddle cache lines cost twice.
struct alignas(kLanes * sizeof(double)) Lanes {
  double values[kLanes] = {};
};

// One pass over the stack; the stack must outlive it.
class StackBlocks {
 public:
  explicit StackBlocks(const FieldStack& stack);

  // Loads the next block; false at the end of the stack.
  bool Next();

  size_t begin() const { return begin_; }          // its first location
  size_t count() const { return count_; }          // its locations, the others are zeros
  bool all_finite() const { return all_finite_; }  // of the valid ones
  const double* values() const {
    return block_.front().values;
  }  // [padded_levels, kBlockLocations]
  int padded_levels() const { return padded_levels_; }

 private:
  FloatBlock Source();
  FloatBlock CopyOfTail();

  const FieldStack& stack_;
  const int levels_;
  const int padded_levels_;
  std::vector<Lanes> block_;
  std::vector<float> tail_;
  std::vector<uint8_t> tail_valid_;
  size_t begin_ = 0;
  size_t count_ = 0;
  bool all_finite_ = true;
};

// Over the valid locations of the whole stack.
struct StackMoments {
  size_t locations = 0;
  bool all_finite = true;
  std::vector<double> means;     // [levels]
  std::vector<double> products;  // [levels, levels]
};
StackMoments MeasureMoments(const FieldStack& stack);

}  // namespace eyebox::fit

#endif  // EYEBOX_FIT_FIELD_STACK_BLOCKS_H_
