#include "optics/scatter/block_image.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

namespace eyebox::optics {
namespace {

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

ValidSums SumsOf(const Image<uint8_t>& mask, const Image<float>& image) {
  ValidSums sums{Image<float>(image.size()), Image<float>(image.size())};
  for (size_t i = 0; i < image.pixels().size(); ++i) {
    const bool valid = mask.pixels()[i] == 0;
    sums.sum.pixels()[i] = valid ? image.pixels()[i] : 0;
    sums.count.pixels()[i] = valid ? 1 : 0;
  }
  return sums;
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

bool FillMasked(const Image<uint8_t>& mask, Image<float>& image) {
  const auto flags = mask.pixels();
  if (std::ranges::all_of(flags, [](uint8_t m) { return m == 0; })) return false;
  std::vector<ValidSums> levels = {SumsOf(mask, image)};
  while (levels.back().sum.pixels().size() > 1) levels.push_back(Halve(levels.back()));
  for (int y = 0; y < image.size().height_px; ++y) {
    for (int x = 0; x < image.size().width_px; ++x) {
      if (mask.at(x, y) == 0) continue;
      image.at(x, y) = 0;
      for (size_t k = 1; k < levels.size(); ++k) {
        const float count = levels[k].count.at(x >> k, y >> k);
        if (!(count > 0)) continue;
        image.at(x, y) = levels[k].sum.at(x >> k, y >> k) / count;
        break;
      }
    }
  }
  return true;
}

}  // namespace eyebox::optics
