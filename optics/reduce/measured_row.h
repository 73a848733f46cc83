// Some pixels of a measured quantity, borrowed.
#ifndef EYEBOX_OPTICS_REDUCE_MEASURED_ROW_H_
#define EYEBOX_OPTICS_REDUCE_MEASURED_ROW_H_

#include <cstddef>
#include <cstdint>
#include <span>

#include "optics/reduce/measured_image.h"

namespace eyebox::optics {

// As MeasuredImage has them, all three of one length. Valid while their owner lives.
struct ConstMeasuredRow {
  std::span<const float> value;
  std::span<const float> variance;
  std::span<const uint8_t> mask;

  size_t size() const { return mask.size(); }
};

struct MeasuredRow {
  std::span<float> value;
  std::span<float> variance;
  std::span<uint8_t> mask;

  size_t size() const { return mask.size(); }
  // As a span of const from a span.
  operator ConstMeasuredRow() const { return {value, variance, mask}; }
};

inline MeasuredRow RowOf(MeasuredImage& image, int y) {
  return {image.value.row(y), image.variance.row(y), image.mask.row(y)};
}
inline MeasuredRow PixelsOf(MeasuredImage& image) {
  return {image.value.pixels(), image.variance.pixels(), image.mask.pixels()};
}
inline ConstMeasuredRow PixelsOf(const MeasuredImage& image) {
  return {image.value.pixels(), image.variance.pixels(), image.mask.pixels()};
}

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_REDUCE_MEASURED_ROW_H_
