// A measured quantity per pixel: value, variance and why a pixel has none.
#ifndef EYEBOX_OPTICS_REDUCE_MEASURED_IMAGE_H_
#define EYEBOX_OPTICS_REDUCE_MEASURED_IMAGE_H_

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "capture/base/image.h"

namespace eyebox::optics {

// Why a pixel is not valid; bits, several may be set. "All saturated" and "all dark" differ.
enum PixelFlag : uint8_t {
  kSaturated = 1 << 0,     // at the upper rail, or next to a pixel that is
  kUnderexposed = 1 << 1,  // so close to 0 DN that the camera clips the noise
  kDefective = 1 << 2,     // hot or dead
  kNoFlat = 1 << 3,        // the flat has no usable value here
  kNoData = 1 << 4,        // nothing was measured here
  kRepaired = 1 << 5,      // beside kDefective: the value is that of neighbours, not measured
};

inline constexpr float kNoValue = std::numeric_limits<float>::quiet_NaN();

// value, variance and mask are [height, width]. Invariant: where mask is not 0, value and variance
// are NaN, but for the value of repaired pixels; where it is 0, both are finite and variance > 0.
// Values may be negative.
struct MeasuredImage {
  Image<float> value;                // unit
  Image<float> variance;             // unit squared; independent from pixel to pixel
  Image<uint8_t> mask;               // PixelFlag bits
  std::string unit;                  // "DN", "DN/s", "cd/m2", "relative"
  std::vector<std::string> history;  // one entry per step: its name and arguments

  ImageSize size() const { return value.size(); }
};

// All pixels valid with value 0 and variance 0, to be filled.
MeasuredImage MakeMeasuredImage(ImageSize size, std::string unit);
// Each pixel of all three must be written before it is read.
MeasuredImage UnwrittenMeasuredImage(ImageSize size, std::string unit);

// Writes NaN to value and variance wherever mask is not 0.
void BlankMaskedPixels(MeasuredImage& image);

// Number of pixels with any of `flags` set.
size_t CountFlagged(const MeasuredImage& image, uint8_t flags);

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_REDUCE_MEASURED_IMAGE_H_
