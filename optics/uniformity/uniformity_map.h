// How the luminance of a full field varies over the display: g(x), g = 1 at the reference point
// (Murray, Patel & Wiedenmann 2022, eq 7), raw and as a smooth model, both with uncertainty.
#ifndef EYEBOX_OPTICS_UNIFORMITY_UNIFORMITY_MAP_H_
#define EYEBOX_OPTICS_UNIFORMITY_UNIFORMITY_MAP_H_

#include <optional>

#include "absl/status/statusor.h"
#include "optics/geometry/pixel_point.h"
#include "optics/photometry/luminance_image.h"
#include "optics/uniformity/point_uniformity.h"
#include "optics/uniformity/smooth_field.h"

namespace eyebox::optics {

struct UniformityOptions {
  std::optional<PixelPoint> reference;      // image centre unless given
  double reference_radius_fraction = 0.02;  // of the smaller side of the image
  double patch_radius_fraction = 0.02;      // of the 9- and 13-point patches, likewise
  int polynomial_order = 4;                 // total degree of the smooth model
};

struct FieldRange {
  double minimum = 0;
  double maximum = 0;
};

struct UniformityMap {
  PixelPoint reference;
  double reference_luminance = 0;        // mean over the reference disk, unit of the input
  double reference_luminance_sigma = 0;  // of noise; the scale's is common and cancels in g
  MeasuredImage raw;                     // g = L(x) / L(reference), unit "1"
  SmoothField smooth;                    // 1 at the reference point
  FieldRange raw_range;                  // over valid pixels
  FieldRange smooth_range;               // over valid pixels
  double residual_rms = 0;               // raw - smooth
  double residual_rms_expected = 0;      // what the noise of raw alone would leave
  PointUniformity nine_points;
  PointUniformity thirteen_points;
};

// Errors: InvalidArgument (reference outside the image, order outside 0 to 8), FailedPrecondition
// (no valid pixel in the reference disk or a patch, its luminance is not above 0 by 5 sigma, fewer
// valid pixels than coefficients).
absl::StatusOr<UniformityMap> MeasureUniformity(const LuminanceImage& full_field,
                                                const UniformityOptions& options = {});

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_UNIFORMITY_UNIFORMITY_MAP_H_
