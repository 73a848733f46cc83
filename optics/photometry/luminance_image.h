// Luminance per pixel, with the uncertainties that all pixels share kept apart.
#ifndef EYEBOX_OPTICS_PHOTOMETRY_LUMINANCE_IMAGE_H_
#define EYEBOX_OPTICS_PHOTOMETRY_LUMINANCE_IMAGE_H_

#include <cstddef>

#include "capture/base/image.h"
#include "optics/reduce/measured_image.h"

namespace eyebox::optics {

struct LuminanceImage {
  MeasuredImage image;  // unit "cd/m2", or "relative" where no known luminance was recorded
  // Relative standard uncertainty of the scale, common to all pixels and not part of
  // image.variance; 0 where relative (a ratio of two such images has no scale).
  double scale_relative_sigma = 0;
  // One standard uncertainty of the scattered light that was taken out, [height, width], unit of
  // the image, signed: the error is this image times one unknown number, so that a mean over pixels
  // has it whole. Not part of image.variance, and the same number in all images of one instrument.
  // Empty: none was taken out.
  Image<float> scatter_sigma = {};
  bool absolute = false;        // cd/m2
  bool flat_corrected = false;  // vignetting and pixel response are divided out

  // Of the scattered light at a pixel (row-major index); 0 where none was taken out.
  double ScatterSigma(size_t pixel) const {
    return scatter_sigma.empty() ? 0 : scatter_sigma.pixels()[pixel];
  }
};

// Variances of the pixels with that of the scattered light, apart from the scale's.
inline Image<float> VarianceWithScatter(const LuminanceImage& luminance) {
  Image<float> variance = luminance.image.variance;
  if (luminance.scatter_sigma.empty()) return variance;
  for (size_t i = 0; i < variance.pixels().size(); ++i) {
    const float sigma = luminance.scatter_sigma.pixels()[i];
    variance.pixels()[i] += sigma * sigma;
  }
  return variance;
}

// A luminance that is known from elsewhere.
struct KnownLuminance {
  double luminance_cd_m2 = 0;
  double relative_sigma = 0;  // standard uncertainty
};

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_PHOTOMETRY_LUMINANCE_IMAGE_H_
