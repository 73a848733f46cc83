// An image in blocks of equal size, for what varies slowly.
#ifndef EYEBOX_OPTICS_SCATTER_BLOCK_IMAGE_H_
#define EYEBOX_OPTICS_SCATTER_BLOCK_IMAGE_H_

#include <span>

#include "capture/base/image.h"

namespace eyebox::optics {

ImageSize BlockGridSize(ImageSize size, int block_px);

// Sum over each block / block_px^2: a block that the edge cuts counts 0 outside. NaN counts 0.
Image<float> BlockMeans(const Image<float>& image, int block_px);

// One row of the full image, bilinear between the middles of blocks, constant past the outer ones.
void ExpandRow(const Image<float>& blocks, int block_px, int y, std::span<float> row);

// Gives each masked pixel the mean of the smallest block around it (2, 4, 8, ... pixels wide) that
// holds valid ones; 0 if none is valid in the whole image.
void FillMasked(const Image<uint8_t>& mask, Image<float>& image);

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_SCATTER_BLOCK_IMAGE_H_
