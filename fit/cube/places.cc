#include "fit/cube/places.h"

#include <algorithm>
#include <cmath>

namespace eyebox::fit {

ImageSize PlaceGrid::size() const {
  return {(pixels.width_px + side_px - 1) / side_px, (pixels.height_px + side_px - 1) / side_px};
}

std::vector<size_t> PlaceGrid::PixelsOf(size_t index) const {
  const int columns = size().width_px;
  const int left = static_cast<int>(index) % columns * side_px;
  const int top = static_cast<int>(index) / columns * side_px;
  std::vector<size_t> found;
  for (int y = top; y < std::min(top + side_px, pixels.height_px); ++y) {
    for (int x = left; x < std::min(left + side_px, pixels.width_px); ++x) {
      found.push_back(static_cast<size_t>(y) * static_cast<size_t>(pixels.width_px) +
                      static_cast<size_t>(x));
    }
  }
  return found;
}

std::pair<double, double> PlaceGrid::CentreOf(size_t index) const {
  const int columns = size().width_px;
  const int left = static_cast<int>(index) % columns * side_px;
  const int top = static_cast<int>(index) / columns * side_px;
  return {(left + std::min(left + side_px, pixels.width_px) - 1) / 2.0,
          (top + std::min(top + side_px, pixels.height_px) - 1) / 2.0};
}

PlaceSeries AverageOverPlace(const PlaceGrid& grid, size_t index, size_t levels,
                             std::span<const float> luminance, std::span<const uint8_t> valid) {
  std::vector<size_t> members = grid.PixelsOf(index);
  const size_t all = members.size();
  std::erase_if(members, [&](size_t pixel) { return valid[pixel] == 0; });
  PlaceSeries series;
  if (members.empty() || 2 * members.size() < all) return series;
  const size_t stride = valid.size();
  const auto count = static_cast<double>(members.size());
  double mean_squares = 0;
  for (size_t level = 0; level < levels; ++level) {
    double sum = 0;
    for (size_t pixel : members) sum += luminance[level * stride + pixel];
    series.mean.push_back(sum / count);
    mean_squares += series.mean.back() * series.mean.back();
  }
  series.sigma.assign(levels, 0);
  if (members.size() < 2) return series;
  for (size_t pixel : members) {
    double product = 0;
    for (size_t level = 0; level < levels; ++level) {
      product += series.mean[level] * luminance[level * stride + pixel];
    }
    const double gain = mean_squares > 0 ? product / mean_squares : 1;
    for (size_t level = 0; level < levels; ++level) {
      const double residual = luminance[level * stride + pixel] - gain * series.mean[level];
      series.sigma[level] += residual * residual;
    }
  }
  for (double& sigma : series.sigma) sigma = std::sqrt(sigma / ((count - 1) * count));
  return series;
}

}  // namespace eyebox::fit
