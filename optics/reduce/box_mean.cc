#include "optics/reduce/box_mean.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "capture/base/vectorise.h"

namespace eyebox::optics {
namespace {

EYEBOX_VECTORISE
void SplitValid(std::span<const float> row, float* value, float* count) {
  for (size_t x = 0; x < row.size(); ++x) {
    const bool valid = !std::isnan(row[x]);
    value[x] = valid ? row[x] : 0.0F;
    count[x] = valid ? 1.0F : 0.0F;
  }
}

EYEBOX_VECTORISE
void AddSpan(const float* more, size_t count, float* sum) {
  for (size_t x = 0; x < count; ++x) sum[x] += more[x];
}

// The usual window, in one pass; the order of the sum is that of AddSpan one after the other.
EYEBOX_VECTORISE
void SumFive(const std::array<const float*, 5>& rows, size_t count, float* __restrict__ sum) {
  const auto [first, second, third, fourth, fifth] = rows;
  for (size_t x = 0; x < count; ++x) {
    sum[x] = (((first[x] + second[x]) + third[x]) + fourth[x]) + fifth[x];
  }
}

void SumWindow(const float* padded, int radius, int step_px, std::vector<float>& sum) {
  if (radius == 2) {
    const auto at = [&](int k) { return padded + static_cast<size_t>(k) * step_px; };
    return SumFive({at(0), at(1), at(2), at(3), at(4)}, sum.size(), sum.data());
  }
  std::copy_n(padded, sum.size(), sum.begin());
  for (int k = 1; k <= 2 * radius; ++k) {
    AddSpan(padded + static_cast<size_t>(k) * step_px, sum.size(), sum.data());
  }
}

EYEBOX_VECTORISE
void Divide(const float* sum, const float* count, std::span<float> mean) {
  for (size_t x = 0; x < mean.size(); ++x) mean[x] = sum[x] / count[x];
}

}  // namespace

BoxMeanRows::BoxMeanRows(int width_px, int radius, int step_px)
    : radius_(radius), step_px_(step_px) {
  const auto width = static_cast<size_t>(width_px);
  const auto margin = static_cast<size_t>(reach());
  window_ = {std::vector<float>(width), std::vector<float>(width)};
  ring_.assign(2 * margin + 1, window_);
  padded_.resize(width + 2 * margin);
  padded_count_.resize(width + 2 * margin);
}

void BoxMeanRows::Push(int y, std::span<const float> row) {
  RowSums& sums = ring_[static_cast<size_t>(y) % ring_.size()];
  const auto margin = static_cast<size_t>(reach());
  SplitValid(row, padded_.data() + margin, padded_count_.data() + margin);
  SumWindow(padded_.data(), radius_, step_px_, sums.sum);
  SumWindow(padded_count_.data(), radius_, step_px_, sums.count);
}

void BoxMeanRows::SumFiveRows(int y) {
  const auto row = [&](int k) -> const RowSums& {
    return ring_[static_cast<size_t>(y + k * step_px_) % ring_.size()];
  };
  SumFive({row(-2).sum.data(), row(-1).sum.data(), row(0).sum.data(), row(1).sum.data(),
           row(2).sum.data()},
          window_.sum.size(), window_.sum.data());
  SumFive({row(-2).count.data(), row(-1).count.data(), row(0).count.data(), row(1).count.data(),
           row(2).count.data()},
          window_.count.size(), window_.count.data());
}

void BoxMeanRows::SumRows(int y, Rows within) {
  std::ranges::fill(window_.sum, 0.0F);
  std::ranges::fill(window_.count, 0.0F);
  for (int row = y - reach(); row <= y + reach(); row += step_px_) {
    if (row < within.first || row >= within.end) continue;
    const RowSums& sums = ring_[static_cast<size_t>(row) % ring_.size()];
    AddSpan(sums.sum.data(), sums.sum.size(), window_.sum.data());
    AddSpan(sums.count.data(), sums.count.size(), window_.count.data());
  }
}

void BoxMeanRows::Mean(int y, Rows within, std::span<float> mean) {
  const bool whole = y - reach() >= within.first && y + reach() < within.end;
  if (radius_ == 2 && whole) {
    SumFiveRows(y);
  } else {
    SumRows(y, within);
  }
  Divide(window_.sum.data(), window_.count.data(), mean);
}

Image<float> BoxMean(const Image<float>& image, int radius, int step_px) {
  const auto [width, height] = image.size();
  Image<float> mean = Image<float>::Unwritten(image.size());
  BoxMeanRows rows(width, radius, step_px);
  int pushed = 0;
  for (int y = 0; y < height; ++y) {
    for (; pushed < std::min(height, y + rows.reach() + 1); ++pushed) {
      rows.Push(pushed, image.row(pushed));
    }
    rows.Mean(y, AllRows(image.size()), mean.row(y));
  }
  return mean;
}

}  // namespace eyebox::optics
