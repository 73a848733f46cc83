#include "service/preflight/frame_figures.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace eyebox::service {
namespace {

double MeanAt(std::span<const Counts> frames, size_t pixel) {
  double sum = 0;
  for (const Counts& frame : frames) sum += frame[pixel];
  return sum / static_cast<double>(frames.size());
}

// Of the mean over the mask of one frame, from the differences of two.
double SigmaFromPixels(const Counts& first, const Counts& second, const Mask& mask) {
  double n = 0, sum = 0, squares = 0;
  for (size_t i = 0; i < mask.size(); ++i) {
    if (mask[i] == 0) continue;
    const double difference = static_cast<double>(first[i]) - second[i];
    ++n, sum += difference, squares += difference * difference;
  }
  if (n < 2) return 0;
  const double variance = std::max(squares / n - sum * sum / (n * n), 0.0);
  return std::sqrt(variance / 2 / n);
}

}  // namespace

Mask PixelsBelow(std::span<const Counts> frames, double limit_dn) {
  if (frames.empty()) return {};
  Mask mask(frames[0].size(), 1);
  for (const Counts& frame : frames) {
    for (size_t i = 0; i < mask.size(); ++i) {
      if (frame[i] >= limit_dn) mask[i] = 0;
    }
  }
  return mask;
}

uint16_t Quantile(const Counts& frame, double share) {
  Counts sorted = frame;
  const auto rank = static_cast<std::ptrdiff_t>(share * static_cast<double>(sorted.size() - 1));
  std::nth_element(sorted.begin(), sorted.begin() + rank, sorted.end());
  return sorted[static_cast<size_t>(rank)];
}

double MeanOf(const Counts& frame, const Mask& mask) {
  double sum = 0, n = 0;
  for (size_t i = 0; i < mask.size(); ++i) {
    if (mask[i] == 0) continue;
    ++n, sum += frame[i];
  }
  return n > 0 ? sum / n : 0;
}

std::vector<double> MeansOf(std::span<const Counts> frames, const Mask& mask) {
  std::vector<double> means;
  for (const Counts& frame : frames) means.push_back(MeanOf(frame, mask));
  return means;
}

FieldMean MeanOfField(std::span<const Counts> frames, const Mask& mask) {
  FieldMean field;
  if (frames.empty()) return field;
  const std::vector<double> means = MeansOf(frames, mask);
  const auto n = static_cast<double>(means.size());
  field.mean_dn = std::accumulate(means.begin(), means.end(), 0.0) / n;
  if (frames.size() < 2) return field;
  double squares = 0;
  for (const double mean : means) squares += std::pow(mean - field.mean_dn, 2);
  field.pixel_sigma_dn = SigmaFromPixels(frames[0], frames[1], mask) / std::sqrt(n);
  field.sigma_dn = std::max(std::sqrt(squares / (n - 1) / n), field.pixel_sigma_dn);
  return field;
}

std::vector<double> RowMeans(const Counts& frame, ImageSize size) {
  std::vector<double> means;
  for (int y = 0; y < size.height_px; ++y) {
    const auto begin = frame.begin() + static_cast<std::ptrdiff_t>(y) * size.width_px;
    means.push_back(std::accumulate(begin, begin + size.width_px, 0.0) / size.width_px);
  }
  return means;
}

Image<double> MeanField(std::span<const Counts> light, std::span<const Counts> dark, ImageSize size,
                        int stride) {
  Image<double> field({.width_px = size.width_px / stride, .height_px = size.height_px / stride});
  for (int y = 0; y < field.size().height_px; ++y) {
    for (int x = 0; x < field.size().width_px; ++x) {
      const size_t pixel = (static_cast<size_t>(y) * size.width_px + x) * stride;
      field.at(x, y) = MeanAt(light, pixel) - MeanAt(dark, pixel);
    }
  }
  return field;
}

}  // namespace eyebox::service
