#include "optics/reduce/divide_by_flat.h"

#include <vector>

#include "absl/strings/str_cat.h"
#include "capture/base/parallel.h"
#include "capture/base/status.h"
#include "capture/base/vectorise.h"
#include "optics/sensor/median.h"

namespace eyebox::optics {
namespace {

constexpr size_t kMedianSamples = 1 << 18;  // enough for a threshold of a few percent

double MedianOfValid(const MeasuredImage& image) {
  const auto value = image.value.pixels();
  const auto mask = image.mask.pixels();
  const size_t stride = value.size() / kMedianSamples + 1;
  std::vector<float> sample;
  for (size_t i = 0; i < value.size(); i += stride) {
    if (mask[i] == 0) sample.push_back(value[i]);
  }
  return Median(std::move(sample));
}

// What is written is not read elsewhere: said here, because the compiler gives up comparing arrays.
EYEBOX_VECTORISE
void DividePixels(size_t count, const float* flat, const float* flat_variance, float lowest,
                  float* __restrict__ value, float* __restrict__ variance,
                  uint8_t* __restrict__ mask) {
  for (size_t i = 0; i < count; ++i) {
    const float per_flat = 1.0F / flat[i];
    const float ratio = value[i] * per_flat;
    // NaN compares false, so that a masked flat is unusable too.
    const bool usable = (flat[i] >= lowest) & (flat[i] * flat[i] > 25.0F * flat_variance[i]);
    const auto reasons = static_cast<uint8_t>(mask[i] | (usable ? 0 : kNoFlat));
    const float ratio_variance =
        (variance[i] + ratio * ratio * flat_variance[i]) * per_flat * per_flat;
    value[i] = reasons != 0 ? kNoValue : ratio;
    variance[i] = reasons != 0 ? kNoValue : ratio_variance;
    mask[i] = reasons;
  }
}

}  // namespace

absl::StatusOr<MeasuredImage> DivideByFlat(MeasuredImage image, const MeasuredImage& response,
                                           double minimum) {
  if (image.size() != response.size()) {
    return BadInput("flat", "its size differs from the image's",
                    "record both with one region of interest");
  }
  const double median = MedianOfValid(response);
  if (!(median > 0)) {
    return Rejected("flat", "it has no light in it", "record a uniform source, well exposed");
  }
  const auto lowest = static_cast<float>(minimum * median);
  ForEachPieceInParallel(image.mask.pixels().size(), [&](size_t first, size_t end) {
    DividePixels(end - first, response.value.pixels().data() + first,
                 response.variance.pixels().data() + first, lowest,
                 image.value.pixels().data() + first, image.variance.pixels().data() + first,
                 image.mask.pixels().data() + first);
  });
  image.unit = image.unit == response.unit ? "1" : absl::StrCat(image.unit, " / ", response.unit);
  image.history.push_back(absl::StrCat("DivideByFlat(median ", median, ", minimum ", minimum, ")"));
  return image;
}

}  // namespace eyebox::optics
