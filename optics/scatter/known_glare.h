// The scatter of an instrument as it is taken out of its images.
#ifndef EYEBOX_OPTICS_SCATTER_KNOWN_GLARE_H_
#define EYEBOX_OPTICS_SCATTER_KNOWN_GLARE_H_

#include "optics/scatter/scatter_kernel.h"

namespace eyebox::optics {

// What shines beside the image.
enum class Surround {
  kUnknown,    // as its border, and all glare from there counts as uncertain
  kContinued,  // as its border: the display reaches further than the camera sees
  kDark,       // nothing: the camera sees the whole display
};

struct KnownGlare {
  ScatterKernel kernel;
  double relative_sigma = 0;  // of the energy in tail and pedestal, from the fit of w
  double pitch_deg = 0;       // of a pixel; the image has equal steps in field angle
  Surround surround = Surround::kUnknown;
};

struct GlareRemovalFigures {
  double removed_share = 0;      // light taken away, of the light read; over the valid pixels
  double floor_median = 0;       // luminance below which the result cannot be trusted, see
                                 // ScatterCorrection
  double below_floor_share = 0;  // of the valid pixels
  double variance_share = 0;     // of the mean variance, what the correction added
  double common_share = 0;       // mean square of scatter_sigma over that variance
};

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_SCATTER_KNOWN_GLARE_H_
