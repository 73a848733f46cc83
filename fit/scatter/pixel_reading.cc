#include "fit/scatter/pixel_reading.h"

#include <array>
#include <cmath>

namespace eyebox::fit {
namespace {

// Gauss-Legendre over a pixel's width.
constexpr std::array<double, 3> kNodes = {-0.3872983346207417, 0, 0.3872983346207417};
constexpr std::array<double, 3> kWeights = {5.0 / 18, 8.0 / 18, 5.0 / 18};

}  // namespace

void PixelReading::Add(double x_px, double y_px, double luminance, double variance) {
  ++pixels_;
  luminance_ += luminance;
  variance_ += variance;
  for (size_t j = 0; j < kNodes.size(); ++j) {
    for (size_t i = 0; i < kNodes.size(); ++i) {
      const double x = x_px + kNodes[i];
      const double y = y_px + kNodes[j];
      const double square = x * x + y * y;
      const auto at = static_cast<size_t>(std::sqrt(square) / step_px_);
      if (bins_.empty()) first_ = at;
      if (at < first_) {
        bins_.insert(bins_.begin(), first_ - at, Bin{});
        first_ = at;
      }
      if (at - first_ >= bins_.size()) bins_.resize(at - first_ + 1);
      Bin& bin = bins_[at - first_];
      const double share = kWeights[i] * kWeights[j];
      bin.share += share;
      bin.square_px += share * square;
    }
  }
}

GlareReading PixelReading::Finish(double pitch_deg) const {
  const auto pixels = static_cast<double>(pixels_);
  GlareReading reading;
  reading.luminance = luminance_ / pixels;
  reading.luminance_sigma = std::sqrt(variance_) / pixels;
  double square_px = 0;
  for (const Bin& bin : bins_) {
    if (bin.share == 0) continue;
    square_px += bin.square_px / pixels;
    reading.offsets.push_back(
        {std::sqrt(bin.square_px / bin.share) * pitch_deg, bin.share / pixels});
  }
  reading.offset_deg = std::sqrt(square_px) * pitch_deg;
  return reading;
}

}  // namespace eyebox::fit
