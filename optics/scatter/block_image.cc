#include "optics/scatter/block_image.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace eyebox::optics {
namespace {

constexpr int kDirectLevels = 3;  // blocks up to 8 pixels wide are summed where they are needed

// Between which blocks a pixel lies, and how far towards the second.
struct Between {
  int first = 0;
  int second = 0;
  float part = 0;
};

Between Locate(int pixel, int block_px, int blocks) {
  const float position =
      std::clamp((static_cast<float>(pixel) + 0.5F) / static_cast<float>(block_px) - 0.5F, 0.0F,
                 static_cast<float>(blocks - 1));
  const int first = static_cast<int>(position);
  return {first, std::min(first + 1, blocks - 1), position - static_cast<float>(first)};
}

struct ValidSums {
  Image<float> sum;
  Image<float> count;
};

ValidSums Halve(const ValidSums& fine) {
  const ImageSize size = BlockGridSize(fine.sum.size(), 2);
  ValidSums coarse{Image<float>(size), Image<float>(size)};
  for (int y = 0; y < fine.sum.size().height_px; ++y) {
    for (int x = 0; x < fine.sum.size().width_px; ++x) {
      coarse.sum.at(x / 2, y / 2) += fine.sum.at(x, y);
      coarse.count.at(x / 2, y / 2) += fine.count.at(x, y);
    }
  }
  return coarse;
}

// Over the blocks of 2^kDirectLevels pixels.
ValidSums SumsOf(const Image<uint8_t>& mask, const Image<float>& image) {
  const ImageSize size = BlockGridSize(image.size(), 1 << kDirectLevels);
  ValidSums sums{Image<float>(size), Image<float>(size)};
  for (int y = 0; y < image.size().height_px; ++y) {
    for (int x = 0; x < image.size().width_px; ++x) {
      if (mask.at(x, y) != 0) continue;
      sums.sum.at(x >> kDirectLevels, y >> kDirectLevels) += image.at(x, y);
      sums.count.at(x >> kDirectLevels, y >> kDirectLevels) += 1;
    }
  }
  return sums;
}

// Mean of the valid pixels of the block of 2^level pixels around (x, y).
std::optional<float> MeanOfBlock(const Image<uint8_t>& mask, const Image<float>& image, int x,
                                 int y, int level) {
  const int left = (x >> level) << level;
  const int top = (y >> level) << level;
  float sum = 0;
  float count = 0;
  for (int v = top; v < std::min(top + (1 << level), image.size().height_px); ++v) {
    for (int u = left; u < std::min(left + (1 << level), image.size().width_px); ++u) {
      if (mask.at(u, v) != 0) continue;
      sum += image.at(u, v);
      count += 1;
    }
  }
  if (count > 0) return sum / count;
  return std::nullopt;
}

// The same for large blocks, from sums that are made once they are needed.
class LargeBlocks {
 public:
  LargeBlocks(const Image<uint8_t>& mask, const Image<float>& image) : mask_(mask), image_(image) {}

  float MeanAround(int x, int y) {
    if (levels_.empty()) Build();
    for (size_t k = 0; k < levels_.size(); ++k) {
      const int level = kDirectLevels + static_cast<int>(k);
      const float count = levels_[k].count.at(x >> level, y >> level);
      if (count > 0) return levels_[k].sum.at(x >> level, y >> level) / count;
    }
    return 0;
  }

 private:
  void Build() {
    levels_ = {SumsOf(mask_, image_)};
    while (levels_.back().sum.pixels().size() > 1) levels_.push_back(Halve(levels_.back()));
  }

  const Image<uint8_t>& mask_;
  const Image<float>& image_;
  std::vector<ValidSums> levels_;
};

float FillValue(const Image<uint8_t>& mask, const Image<float>& image, int x, int y,
                LargeBlocks& large) {
  for (int level = 1; level <= kDirectLevels; ++level) {
    const std::optional<float> mean = MeanOfBlock(mask, image, x, y, level);
    if (mean.has_value()) return *mean;
  }
  return large.MeanAround(x, y);
}

}  // namespace

ImageSize BlockGridSize(ImageSize size, int block_px) {
  return {(size.width_px + block_px - 1) / block_px, (size.height_px + block_px - 1) / block_px};
}

Image<float> BlockMeans(const Image<float>& image, int block_px) {
  Image<float> blocks(BlockGridSize(image.size(), block_px));
  const float scale = 1 / (static_cast<float>(block_px) * static_cast<float>(block_px));
  const int width = image.size().width_px;
  for (int y = 0; y < image.size().height_px; ++y) {
    const auto row = image.row(y);
    const auto out = blocks.row(y / block_px);
    for (int x = 0, block = 0; x < width; ++block) {
      float sum = 0;
      for (const int end = std::min(x + block_px, width); x < end; ++x) {
        sum += std::isnan(row[x]) ? 0.0F : row[x];
      }
      out[block] += sum * scale;
    }
  }
  return blocks;
}

void ExpandRow(const Image<float>& blocks, int block_px, int y, std::span<float> row) {
  const Between v = Locate(y, block_px, blocks.size().height_px);
  const auto upper = blocks.row(v.first);
  const auto lower = blocks.row(v.second);
  const int columns = blocks.size().width_px;
  const auto at = [&](int x) { return upper[x] + v.part * (lower[x] - upper[x]); };
  const int width = static_cast<int>(row.size());
  // Between the middles of two neighbouring blocks the row is a straight line.
  for (int block = -1; block < columns; ++block) {
    const float from = at(std::max(block, 0));
    const float step = (at(std::min(block + 1, columns - 1)) - from) / static_cast<float>(block_px);
    const float middle = (static_cast<float>(block) + 0.5F) * static_cast<float>(block_px) - 0.5F;
    const int begin = std::max(static_cast<int>(std::ceil(middle)), 0);
    const int end = std::min(
        block + 1 == columns ? width : static_cast<int>(std::ceil(middle)) + block_px, width);
    for (int x = begin; x < end; ++x) row[x] = from + step * (static_cast<float>(x) - middle);
  }
}

void FillMasked(const Image<uint8_t>& mask, Image<float>& image) {
  LargeBlocks large(mask, image);
  for (int y = 0; y < image.size().height_px; ++y) {
    for (int x = 0; x < image.size().width_px; ++x) {
      if (mask.at(x, y) != 0) image.at(x, y) = FillValue(mask, image, x, y, large);
    }
  }
}

}  // namespace eyebox::optics
