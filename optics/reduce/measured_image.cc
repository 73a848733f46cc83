#include "optics/reduce/measured_image.h"

#include <algorithm>
#include <utility>
#include "capture/base/vectorise.h"

namespace eyebox::optics {

MeasuredImage MakeMeasuredImage(ImageSize size, std::string unit) {
  MeasuredImage image;
  image.value = Image<float>(size);
  image.variance = Image<float>(size);
  image.mask = Image<uint8_t>(size);
  image.unit = std::move(unit);
  return image;
}

MeasuredImage UnwrittenMeasuredImage(ImageSize size, std::string unit) {
  MeasuredImage image;
  image.value = Image<float>::Unwritten(size);
  image.variance = Image<float>::Unwritten(size);
  image.mask = Image<uint8_t>::Unwritten(size);
  image.unit = std::move(unit);
  return image;
}

EYEBOX_VECTORISE
void BlankMaskedPixels(MeasuredImage& image) {
  float* const value = image.value.pixels().data();
  float* const variance = image.variance.pixels().data();
  const uint8_t* const mask = image.mask.pixels().data();
  const size_t count = image.mask.pixels().size();
  for (size_t i = 0; i < count; ++i) {
    value[i] = mask[i] != 0 ? kNoValue : value[i];
    variance[i] = mask[i] != 0 ? kNoValue : variance[i];
  }
}

size_t CountFlagged(const MeasuredImage& image, uint8_t flags) {
  const auto mask = image.mask.pixels();
  return static_cast<size_t>(
      std::count_if(mask.begin(), mask.end(), [flags](uint8_t m) { return (m & flags) != 0; }));
}

}  // namespace eyebox::optics
