// The part of a pixel's variance that all images share: that of the flat they were divided by.
#ifndef EYEBOX_OPTICS_REDUCE_FLAT_VARIANCE_H_
#define EYEBOX_OPTICS_REDUCE_FLAT_VARIANCE_H_

#include <algorithm>
#include <cstddef>

#include "optics/reduce/calibration.h"

namespace eyebox::optics {

// What the flat's error adds to the variance of a pixel (row-major index) of this luminance, the
// same error in every image that was divided by it; 0 without a flat.
inline double FlatVariance(double luminance, const Calibration& calibration, size_t pixel) {
  if (!calibration.flat) return 0;
  const MeasuredImage& response = calibration.flat->response;
  const double relative = luminance / response.value.pixels()[pixel];
  return relative * relative * response.variance.pixels()[pixel];
}

// The image with the variance of its own alone, for comparisons of images that share the flat.
inline MeasuredImage WithoutFlat(MeasuredImage image, const Calibration& calibration) {
  // Single precision may lose the difference where the flat is nearly all of the variance.
  constexpr double kLeastShare = 1e-6;
  for (size_t i = 0; i < image.value.pixels().size(); ++i) {
    const double whole = image.variance.pixels()[i];
    const double own = whole - FlatVariance(image.value.pixels()[i], calibration, i);
    if (image.mask.pixels()[i] == 0) {
      image.variance.pixels()[i] = static_cast<float>(std::max(own, kLeastShare * whole));
    }
  }
  return image;
}

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_REDUCE_FLAT_VARIANCE_H_
