// A field seen as places: squares of pixels whose mean is less noisy than any of them.
#ifndef EYEBOX_FIT_CUBE_PLACES_H_
#define EYEBOX_FIT_CUBE_PLACES_H_

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "capture/base/image.h"

namespace eyebox::fit {

struct PlaceGrid {
  ImageSize pixels;  // of the field
  int side_px = 1;   // of a place; those at the right and lower edge may be smaller

  ImageSize size() const;  // in places
  // Indices (row-major) of the pixels of place `index` (row-major).
  std::vector<size_t> PixelsOf(size_t index) const;
  // Where its centre lies, in pixels.
  std::pair<double, double> CentreOf(size_t index) const;  // x, y
};

// Mean luminance of one place, level by level.
struct PlaceSeries {
  std::vector<double> mean;   // [levels]; empty where fewer than half of the pixels are valid
  std::vector<double> sigma;  // of the mean, from the scatter of its pixels; each pixel's own gain
                              // is taken out first. 0 for a place of one pixel
};

// `luminance` is [levels, pixels]; a pixel takes part where `valid` [pixels] is not 0.
PlaceSeries AverageOverPlace(const PlaceGrid& grid, size_t index, size_t levels,
                             std::span<const float> luminance, std::span<const uint8_t> valid);

}  // namespace eyebox::fit

#endif  // EYEBOX_FIT_CUBE_PLACES_H_
