#include "optics/reduce/box_mean.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace eyebox::optics {
namespace {

// Sum and number of the valid pixels of each horizontal window of one row.
struct RowSums {
  std::vector<float> sum;
  std::vector<float> count;
};

void SumAlongRow(std::span<const float> row, int radius, int step_px, std::vector<float>& padded,
                 std::vector<float>& padded_count, RowSums& sums) {
  const size_t width = row.size();
  const size_t margin = static_cast<size_t>(radius) * step_px;
  for (size_t x = 0; x < width; ++x) {
    const bool valid = !std::isnan(row[x]);
    padded[margin + x] = valid ? row[x] : 0.0F;
    padded_count[margin + x] = valid ? 1.0F : 0.0F;
  }
  std::fill(sums.sum.begin(), sums.sum.end(), 0.0F);
  std::fill(sums.count.begin(), sums.count.end(), 0.0F);
  for (int k = 0; k <= 2 * radius; ++k) {
    const float* const value = padded.data() + static_cast<size_t>(k) * step_px;
    const float* const count = padded_count.data() + static_cast<size_t>(k) * step_px;
    for (size_t x = 0; x < width; ++x) {
      sums.sum[x] += value[x];
      sums.count[x] += count[x];
    }
  }
}

}  // namespace

Image<float> BoxMean(const Image<float>& image, int radius, int step_px) {
  const auto [width, height] = image.size();
  const int reach = radius * step_px;
  const size_t ring_size = static_cast<size_t>(2 * reach) + 1;
  std::vector<RowSums> ring(ring_size, {std::vector<float>(width), std::vector<float>(width)});
  std::vector<float> padded(width + 2 * static_cast<size_t>(reach));
  std::vector<float> padded_count(padded.size());
  Image<float> mean(image.size());
  std::vector<float> total(width);
  std::vector<float> number(width);
  int next_row = 0;
  for (int y = 0; y < height; ++y) {
    for (; next_row <= std::min(height - 1, y + reach); ++next_row) {
      SumAlongRow(image.row(next_row), radius, step_px, padded, padded_count,
                  ring[next_row % ring_size]);
    }
    std::fill(total.begin(), total.end(), 0.0F);
    std::fill(number.begin(), number.end(), 0.0F);
    for (int row = y - reach; row <= y + reach; row += step_px) {
      if (row < 0 || row >= height) continue;
      const RowSums& sums = ring[row % ring_size];
      for (int x = 0; x < width; ++x) {
        total[x] += sums.sum[x];
        number[x] += sums.count[x];
      }
    }
    const auto out = mean.row(y);
    for (int x = 0; x < width; ++x) out[x] = total[x] / number[x];
  }
  return mean;
}

}  // namespace eyebox::optics
