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

// Large stacks are worked on in pieces of so many locations, on all processors. What the pieces
// give is added in their order, so that results depend neither on timing nor on the number of
// processors.
constexpr size_t kPieceLocations = 512 * kBlockLocations;
int PieceCount(const FieldStack& stack);

// One pass over a piece of the stack; the stack must outlive it.
class StackBlocks {
 public:
  StackBlocks(const FieldStack& stack, int piece);

  // Loads the next block; false at the end of the piece.
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
  size_t end_ = 0;
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
