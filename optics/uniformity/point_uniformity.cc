#include "optics/uniformity/point_uniformity.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "absl/strings/str_cat.h"
#include "capture/base/status.h"

namespace eyebox::optics {
namespace {

// Fractions of width and height.
constexpr std::array<std::array<double, 2>, 13> kPoints = {{{0.1, 0.1},
                                                            {0.5, 0.1},
                                                            {0.9, 0.1},
                                                            {0.1, 0.5},
                                                            {0.5, 0.5},
                                                            {0.9, 0.5},
                                                            {0.1, 0.9},
                                                            {0.5, 0.9},
                                                            {0.9, 0.9},
                                                            {0.3, 0.3},
                                                            {0.7, 0.3},
                                                            {0.3, 0.7},
                                                            {0.7, 0.7}}};

// Of pixels that are valid.
template <typename Visit>
size_t VisitDisk(const Image<uint8_t>& mask, double x_px, double y_px, double radius_px,
                 const Visit& visit) {
  const auto [width, height] = mask.size();
  const int top = std::max(0, static_cast<int>(std::ceil(y_px - radius_px)));
  const int bottom = std::min(height - 1, static_cast<int>(std::floor(y_px + radius_px)));
  const int left = std::max(0, static_cast<int>(std::ceil(x_px - radius_px)));
  const int right = std::min(width - 1, static_cast<int>(std::floor(x_px + radius_px)));
  size_t pixels = 0;
  for (int y = top; y <= bottom; ++y) {
    for (int x = left; x <= right; ++x) {
      if (std::hypot(x - x_px, y - y_px) > radius_px || mask.at(x, y) != 0) continue;
      visit(x, y);
      ++pixels;
    }
  }
  return pixels;
}

}  // namespace

double SigmaOfRatio(const PatchMean& numerator, const PatchMean& denominator) {
  const double ratio = numerator.value / denominator.value;
  const double noise = numerator.NoiseVariance() + ratio * ratio * denominator.NoiseVariance();
  const double scatter = numerator.scatter_sigma - ratio * denominator.scatter_sigma;
  return std::sqrt(noise + scatter * scatter) / denominator.value;
}

PatchRatio RatioOf(const MeasuredImage& image, const PatchMean& patch, const PatchMean& reference) {
  const double ratio = patch.value / reference.value;
  double common = 0;  // covariance of the two means
  VisitDisk(image.mask, patch.x_px, patch.y_px, patch.radius_px, [&](int x, int y) {
    if (std::hypot(x - reference.x_px, y - reference.y_px) > reference.radius_px) return;
    common += image.variance.at(x, y);
  });
  common /= static_cast<double>(patch.pixels) * static_cast<double>(reference.pixels);
  const double noise = patch.NoiseVariance() + ratio * ratio * reference.NoiseVariance();
  const double scatter = patch.scatter_sigma - ratio * reference.scatter_sigma;
  const double variance = std::max(noise - 2 * ratio * common, 0.0) + scatter * scatter;
  return {patch.x_px, patch.y_px, ratio, std::sqrt(variance) / reference.value};
}

absl::StatusOr<PatchMean> MeanOverDisk(const MeasuredImage& image, double x_px, double y_px,
                                       double radius_px) {
  PatchMean patch{x_px, y_px, radius_px};
  double variance = 0;
  patch.pixels = VisitDisk(image.mask, x_px, y_px, radius_px, [&](int x, int y) {
    patch.value += image.value.at(x, y);
    variance += image.variance.at(x, y);
  });
  if (patch.pixels == 0) {
    return Rejected(absl::StrCat("patch at pixel (", x_px, ", ", y_px, ")"),
                    "it holds no valid pixel",
                    "record exposures that neither saturate nor vanish there, or move the patch");
  }
  patch.value /= static_cast<double>(patch.pixels);
  patch.sigma = std::sqrt(variance) / static_cast<double>(patch.pixels);
  return patch;
}

absl::StatusOr<PatchMean> MeanOverDisk(const LuminanceImage& luminance, double x_px, double y_px,
                                       double radius_px) {
  EYEBOX_ASSIGN_OR_RETURN(PatchMean patch, MeanOverDisk(luminance.image, x_px, y_px, radius_px));
  if (luminance.scatter_sigma.empty()) return patch;
  double sum = 0;
  VisitDisk(luminance.image.mask, x_px, y_px, radius_px,
            [&](int x, int y) { sum += luminance.scatter_sigma.at(x, y); });
  patch.scatter_sigma = sum / static_cast<double>(patch.pixels);
  patch.sigma = std::hypot(patch.sigma, patch.scatter_sigma);
  return patch;
}

absl::StatusOr<PointUniformity> MeasurePointUniformity(const LuminanceImage& luminance,
                                                       PointPattern pattern, double radius_px) {
  const auto [width, height] = luminance.image.size();
  const size_t points = pattern == PointPattern::kNine ? 9 : kPoints.size();
  PointUniformity result;
  for (size_t i = 0; i < points; ++i) {
    EYEBOX_ASSIGN_OR_RETURN(PatchMean patch, MeanOverDisk(luminance, kPoints[i][0] * (width - 1),
                                                          kPoints[i][1] * (height - 1), radius_px));
    result.patches.push_back(patch);
  }
  const auto [low, high] =
      std::minmax_element(result.patches.begin(), result.patches.end(),
                          [](const auto& a, const auto& b) { return a.value < b.value; });
  if (!(high->value > 0)) {
    return Rejected("uniformity", "no patch has light", "measure a full field that is lit");
  }
  result.uniformity = low->value / high->value;
  result.nonuniformity = 1 - result.uniformity;
  result.sigma = SigmaOfRatio(*low, *high);
  return result;
}

}  // namespace eyebox::optics
