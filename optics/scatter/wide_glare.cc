#include "optics/scatter/wide_glare.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "optics/scatter/block_image.h"
#include "optics/scatter/kernel_grid.h"

namespace eyebox::optics {
namespace {

constexpr int kMostBlocks = 192;  // across the larger side
constexpr int kMostRounds = 30;
constexpr float kSoftening = 0.02F;  // of the inverse within a round: the core is left alone
constexpr float kSettled = 1e-5F;    // of the brightest block

int BlockFor(ImageSize size) {
  int block = 1;
  while (std::max(size.width_px, size.height_px) > kMostBlocks * block) block *= 2;
  return block;
}

ImageSize WithMargin(ImageSize blocks) {
  return {blocks.width_px + 2 * ((blocks.width_px + 1) / 2),
          blocks.height_px + 2 * ((blocks.height_px + 1) / 2)};
}

float LargestMagnitude(std::span<const float> values) {
  float largest = 0;
  for (const float value : values) largest = std::max(largest, std::abs(value));
  return largest;
}

}  // namespace

WideGlare::WideGlare(const ScatterKernel& kernel, ImageSize size, double pitch_deg)
    : block_px_(BlockFor(size)),
      torus_(BlockGridSize(size, block_px_)),
      wide_torus_(WithMargin(torus_.window())) {
  const double pitch = pitch_deg * block_px_;
  const RadialWeight weight(kernel), core(CoreOf(kernel));
  const auto share = static_cast<float>(kernel.CoreShare());
  wide_whole_ = wide_torus_.Transfer(SampleKernel(weight, pitch, wide_torus_.window()));
  sharpness_ = wide_torus_.Transfer(SampleKernel(core, pitch, wide_torus_.window()));
  for (size_t i = 0; i < sharpness_.pixels().size(); ++i) {
    const float ratio = wide_whole_.pixels()[i] / std::max(sharpness_.pixels()[i], 1e-6F);
    sharpness_.pixels()[i] = std::clamp(ratio, share, 1.0F);
  }
  Image<float> weights = SampleKernel(weight, pitch, torus_.window());
  whole_ = torus_.Transfer(weights);
  const Image<float> core_weights = SampleKernel(core, pitch, torus_.window());
  for (size_t i = 0; i < weights.pixels().size(); ++i) {
    weights.pixels()[i] = std::max(weights.pixels()[i] - share * core_weights.pixels()[i], 0.0F);
  }
  glare_ = torus_.Transfer(weights);
  const float per_pixel = 1 / (share * static_cast<float>(block_px_));
  for (float& value : weights.pixels()) value = value * value * per_pixel * per_pixel;
  far_noise_gain_ = SumOverGrid(weights);
  far_variance_ = torus_.Transfer(weights);
}

// Rounds of light += softened inverse of (reading - w * light), all within the image.
Image<float> WideGlare::Explain(const Image<float>& reading) {
  Image<float> light(reading.size());
  const float settled = kSettled * LargestMagnitude(reading.pixels());
  Image<float> rest = reading;
  for (int round = 0; round < kMostRounds; ++round) {
    torus_.Filter(rest, [&](int y_frequency, std::span<float> gain) {
      const auto whole = whole_.row(y_frequency);
      for (size_t j = 0; j < gain.size(); ++j) {
        gain[j] = whole[j] / (whole[j] * whole[j] + kSoftening);
      }
    });
    for (size_t i = 0; i < light.pixels().size(); ++i) light.pixels()[i] += rest.pixels()[i];
    if (!(LargestMagnitude(rest.pixels()) > settled)) break;
    rest = light;
    torus_.Filter(rest, whole_);
    for (size_t i = 0; i < rest.pixels().size(); ++i) {
      rest.pixels()[i] = reading.pixels()[i] - rest.pixels()[i];
    }
  }
  return light;
}

Image<float> WideGlare::EdgeCorrection(const Image<float>& reading) {
  const Image<float> light = Explain(reading);
  const auto [width, height] = light.size();
  const int left = (wide_torus_.window().width_px - width) / 2;
  const int top = (wide_torus_.window().height_px - height) / 2;
  Image<float> scattered(wide_torus_.window());
  for (int y = 0; y < height; ++y) {
    std::ranges::copy(light.row(y), scattered.row(top + y).begin() + left);
  }
  wide_torus_.Filter(scattered, wide_whole_);
  for (int y = 0; y < height; ++y) {  // what was seen is not missing
    const auto seen = scattered.row(top + y).subspan(left, width);
    std::ranges::fill(seen, 0.0F);
  }
  wide_torus_.Filter(scattered, [&](int y_frequency, std::span<float> gain) {
    const auto row = sharpness_.row(y_frequency);
    for (size_t j = 0; j < gain.size(); ++j) gain[j] = 1 / row[j];
  });
  Image<float> missing(light.size());
  for (int y = 0; y < height; ++y) {
    std::ranges::copy(scattered.row(top + y).subspan(left, width), missing.row(y).begin());
  }
  return missing;
}

Image<float> WideGlare::FarVariance(Image<float> variance) {
  torus_.Filter(variance, far_variance_);
  for (float& value : variance.pixels()) value = std::max(value, 0.0F);
  return variance;
}

Image<float> WideGlare::GlareOf(Image<float> light) {
  torus_.Filter(light, glare_);
  return light;
}

}  // namespace eyebox::optics
