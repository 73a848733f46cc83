#include "fit/field/stack_blocks.h"

#include <algorithm>

namespace eyebox::fit {
namespace {

int PaddedLevels(int levels) { return (levels + kLevelTile - 1) / kLevelTile * kLevelTile; }

constexpr int kTileSize = kLevelTile * kLevelTile * kLanes;

// Of levels a <= b: tile rows above it hold `tiles`, `tiles` - 1, ... tiles.
size_t PlaceOfProduct(int a, int b, int tiles) {
  const int row = a / kLevelTile;
  const int tile = row * tiles - row * (row - 1) / 2 + b / kLevelTile - row;
  return static_cast<size_t>(tile * kTileSize +
                             (a % kLevelTile * kLevelTile + b % kLevelTile) * kLanes);
}

double SumOfLanes(const double* lanes) {
  double sum = 0;
  for (int lane = 0; lane < kLanes; ++lane) sum += lanes[lane];
  return sum;
}

size_t CountValid(const FieldStack& stack) {
  if (stack.valid.empty()) return stack.LocationCount();
  size_t count = 0;
  for (const uint8_t valid : stack.valid) count += valid != 0 ? 1 : 0;
  return count;
}

}  // namespace

StackBlocks::StackBlocks(const FieldStack& stack)
    : stack_(stack),
      levels_(static_cast<int>(stack.drives.size())),
      padded_levels_(PaddedLevels(levels_)),
      block_(static_cast<size_t>(padded_levels_) * kBlockLocations / kLanes) {}

bool StackBlocks::Next() {
  begin_ += count_;
  count_ = std::min<size_t>(kBlockLocations, stack_.LocationCount() - begin_);
  if (count_ == 0) return false;
  const FloatBlock source = count_ == kBlockLocations ? Source() : CopyOfTail();
  all_finite_ = BestKernels().load(source, levels_, block_.front().values);
  return true;
}

FloatBlock StackBlocks::Source() {
  return {stack_.luminance.data() + begin_, stack_.LocationCount(),
          stack_.valid.empty() ? nullptr : stack_.valid.data() + begin_};
}

FloatBlock StackBlocks::CopyOfTail() {
  tail_.assign(static_cast<size_t>(levels_) * kBlockLocations, 0);
  tail_valid_.assign(kBlockLocations, 0);
  for (int level = 0; level < levels_; ++level) {
    const float* from = stack_.luminance.data() + level * stack_.LocationCount() + begin_;
    std::copy_n(from, count_, tail_.begin() + level * kBlockLocations);
  }
  for (size_t i = 0; i < count_; ++i) {
    tail_valid_[i] = stack_.valid.empty() ? 1 : stack_.valid[begin_ + i];
  }
  return {tail_.data(), kBlockLocations, tail_valid_.data()};
}

StackMoments MeasureMoments(const FieldStack& stack) {
  StackBlocks blocks(stack);
  const int tiles = blocks.padded_levels() / kLevelTile;
  std::vector<double> sums(static_cast<size_t>(blocks.padded_levels()) * kLanes);
  std::vector<double> products(static_cast<size_t>(tiles * (tiles + 1) / 2) * kTileSize);
  StackMoments moments;
  while (blocks.Next()) {
    moments.all_finite &= blocks.all_finite();
    BestKernels().accumulate(blocks.values(), blocks.padded_levels(),
                             {sums.data(), products.data()});
  }
  moments.locations = CountValid(stack);
  const auto levels = static_cast<int>(stack.drives.size());
  for (int a = 0; a < levels; ++a) {
    moments.means.push_back(SumOfLanes(&sums[a * kLanes]) / static_cast<double>(moments.locations));
    for (int b = 0; b < levels; ++b) {
      moments.products.push_back(
          SumOfLanes(&products[PlaceOfProduct(std::min(a, b), std::max(a, b), tiles)]));
    }
  }
  return moments;
}

}  // namespace eyebox::fit
