#include "fit/field/stack_blocks.h"

#include <algorithm>

#include "capture/base/parallel.h"

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

// As the kernels sum them up, see Moments.
struct PieceMoments {
  explicit PieceMoments(int tiles)
      : sums(static_cast<size_t>(tiles * kLevelTile * kLanes)),
        products(static_cast<size_t>(tiles * (tiles + 1) / 2 * kTileSize)) {}

  void Measure(const FieldStack& stack, int piece) {
    StackBlocks blocks(stack, piece);
    while (blocks.Next()) {
      all_finite &= blocks.all_finite();
      BestKernels().accumulate(blocks.values(), blocks.padded_levels(),
                               {sums.data(), products.data()});
    }
  }
  void Add(const PieceMoments& piece) {
    all_finite &= piece.all_finite;
    for (size_t i = 0; i < sums.size(); ++i) sums[i] += piece.sums[i];
    for (size_t i = 0; i < products.size(); ++i) products[i] += piece.products[i];
  }

  bool all_finite = true;
  std::vector<double> sums;
  std::vector<double> products;
};

}  // namespace

int PieceCount(const FieldStack& stack) {
  return static_cast<int>((stack.LocationCount() + kPieceLocations - 1) / kPieceLocations);
}

StackBlocks::StackBlocks(const FieldStack& stack, int piece)
    : stack_(stack),
      levels_(static_cast<int>(stack.drives.size())),
      padded_levels_(PaddedLevels(levels_)),
      block_(static_cast<size_t>(padded_levels_) * kBlockLocations / kLanes),
      begin_(static_cast<size_t>(piece) * kPieceLocations),
      end_(std::min(begin_ + kPieceLocations, stack.LocationCount())) {}

bool StackBlocks::Next() {
  begin_ += count_;
  count_ = std::min<size_t>(kBlockLocations, end_ - begin_);
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
  const auto levels = static_cast<int>(stack.drives.size());
  const int tiles = PaddedLevels(levels) / kLevelTile;
  std::vector<PieceMoments> pieces(static_cast<size_t>(PieceCount(stack)), PieceMoments(tiles));
  ForEachInParallel(PieceCount(stack), [&](int i) { pieces[i].Measure(stack, i); });
  PieceMoments total(tiles);
  for (const PieceMoments& piece : pieces) total.Add(piece);
  StackMoments moments;
  moments.all_finite = total.all_finite;
  moments.locations = CountValid(stack);
  for (int a = 0; a < levels; ++a) {
    moments.means.push_back(SumOfLanes(&total.sums[a * kLanes]) /
                            static_cast<double>(moments.locations));
    for (int b = 0; b < levels; ++b) {
      moments.products.push_back(
          SumOfLanes(&total.products[PlaceOfProduct(std::min(a, b), std::max(a, b), tiles)]));
    }
  }
  return moments;
}

}  // namespace eyebox::fit
