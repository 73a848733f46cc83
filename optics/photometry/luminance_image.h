// Luminance per pixel, with the uncertainty that all pixels share kept apart.
#ifndef EYEBOX_OPTICS_PHOTOMETRY_LUMINANCE_IMAGE_H_
#define EYEBOX_OPTICS_PHOTOMETRY_LUMINANCE_IMAGE_H_

#include "optics/reduce/measured_image.h"

namespace eyebox::optics {

struct LuminanceImage {
  MeasuredImage image;  // unit "cd/m2", or "relative" where no known luminance was recorded
  // Relative standard uncertainty of the scale, common to all pixels and not part of
  // image.variance; 0 where relative (a ratio of two such images has no scale).
  double scale_relative_sigma = 0;
  bool absolute = false;        // cd/m2
  bool flat_corrected = false;  // vignetting and pixel response are divided out
};

// A luminance that is known from elsewhere.
struct KnownLuminance {
  double luminance_cd_m2 = 0;
  double relative_sigma = 0;  // standard uncertainty
};

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_PHOTOMETRY_LUMINANCE_IMAGE_H_
