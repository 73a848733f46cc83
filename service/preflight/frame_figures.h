// Numbers of frames that the checks are made from.
#ifndef EYEBOX_SERVICE_PREFLIGHT_FRAME_FIGURES_H_
#define EYEBOX_SERVICE_PREFLIGHT_FRAME_FIGURES_H_

#include <cstdint>
#include <span>
#include <vector>

#include "capture/base/image.h"
#include "service/preflight/frame_taker.h"

namespace eyebox::service {

using Mask = std::vector<uint8_t>;  // 1: the pixel counts; one of each pixel of a frame

// Pixels below `limit_dn` in every frame.
Mask PixelsBelow(std::span<const Counts> frames, double limit_dn);

// The count that `share` of the pixels do not exceed; frame not empty.
uint16_t Quantile(const Counts& frame, double share);

double MeanOf(const Counts& frame, const Mask& mask);  // 0 for an empty mask
std::vector<double> MeansOf(std::span<const Counts> frames, const Mask& mask);

// Mean of some frames of one setting, and its standard uncertainty: the larger of what the scatter
// from frame to frame and what the noise of the pixels leave. 2 frames at least for the latter.
struct FieldMean {
  double mean_dn = 0;
  double sigma_dn = 0;
  double pixel_sigma_dn = 0;  // the latter alone
};
FieldMean MeanOfField(std::span<const Counts> frames, const Mask& mask);

std::vector<double> RowMeans(const Counts& frame, ImageSize size);

// Mean light minus mean dark, [height, width]; every `stride`-th pixel of both axes, from 0.
Image<double> MeanField(std::span<const Counts> light, std::span<const Counts> dark, ImageSize size,
                        int stride);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_PREFLIGHT_FRAME_FIGURES_H_
