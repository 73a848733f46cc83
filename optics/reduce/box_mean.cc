#include "optics/reduce/box_mean.h"

#include <algorithm>
#include <cmath>
#include <vector>
#include "capture/base/vectorise.h"

namespace eyebox::optics {
namespace {

// Sum and number of the valid pixels of each horizontal window of one row.
struct RowSums {
  std::vector<float> sum;
  std::vector<float> count;
};

EYEBOX_VECTORISE
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

EYEBOX_VECTORISE
void AddRow(const RowSums& row, RowSums& window) {
  float* const total = window.sum.data();
  float* const number = window.count.data();
  const float* const sum = row.sum.data();
  const float* const count = row.count.data();
  const size_t width = row.sum.size();
  for (size_t x = 0; x < width; ++x) {
    total[x] += sum[x];
    number[x] += count[x];
  }
}

EYEBOX_VECTORISE
void DivideBySums(const RowSums& window, std::span<float> mean) {
  for (size_t x = 0; x < mean.size(); ++x) mean[x] = window.sum[x] / window.count[x];
}

}  // namespace

Image<float> BoxMean(const Image<float>& image, int radius, int step_px) {
  const auto [width, height] = image.size();
  const int reach = radius * step_px;
  const size_t ring_size = static_cast<size_t>(2 * reach) + 1;
  std::vector<RowSums> ring(ring_size, {std::vector<float>(width), std::vector<float>(width)});
  std::vector<float> padded(width + 2 * static_cast<size_t>(reach));
  std::vector<float> padded_count(padded.size());
  Image<float> mean = Image<float>::Unwritten(image.size());
  RowSums window{std::vector<float>(width), std::vector<float>(width)};
  int next_row = 0;
  for (int y = 0; y < height; ++y) {
    for (; next_row <= std::min(height - 1, y + reach); ++next_row) {
      SumAlongRow(image.row(next_row), radius, step_px, padded, padded_count,
                  ring[next_row % ring_size]);
    }
    std::fill(window.sum.begin(), window.sum.end(), 0.0F);
    std::fill(window.count.begin(), window.count.end(), 0.0F);
    for (int row = y - reach; row <= y + reach; row += step_px) {
      if (row < 0 || row >= height) continue;
      AddRow(ring[row % ring_size], window);
    }
    DivideBySums(window, mean.row(y));
  }
  return mean;
}

}  // namespace eyebox::optics
