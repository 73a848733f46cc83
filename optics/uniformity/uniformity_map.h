// How the luminance of a full field varies over the display: g(x), g = 1 at the reference point
// (Murray, Patel & Wiedenmann 2022, eq 7), raw and as a smooth model, both with uncertainty.
#ifndef EYEBOX_OPTICS_UNIFORMITY_UNIFORMITY_MAP_H_
#define EYEBOX_OPTICS_UNIFORMITY_UNIFORMITY_MAP_H_

#include <optional>
#include <vector>

#include "absl/status/statusor.h"
#include "optics/geometry/pixel_point.h"
#include "optics/photometry/luminance_image.h"
#include "optics/uniformity/cross_validate.h"
#include "optics/uniformity/point_uniformity.h"
#include "optics/uniformity/smooth_field.h"

namespace eyebox::optics {

struct UniformityOptions {
  std::optional<PixelPoint> reference;      // image centre unless given
  double reference_radius_fraction = 0.02;  // of the smaller side of the image
  double patch_radius_fraction = 0.02;      // of the 9- and 13-point patches, likewise
  // Of the smooth models. Unless given, the polynomial has all orders that the pixels determine,
  // weighted (order_weights.h), and the spline the next number of intervals above that which
  // predicts best (cross_validate.h).
  std::optional<int> polynomial_order;
  std::optional<int> spline_intervals;
};

struct FieldRange {
  double minimum = 0;
  double maximum = 0;
};

// Over all valid pixels of the smooth model, in the style of the IDMS (area uniformity): a single
// pixel's noise would set the extremes of the raw map.
struct AreaUniformity {
  FieldRange g;
  double minimum_sigma = 0;
  double maximum_sigma = 0;
  double mean = 0;
  double deviation = 0;         // standard deviation over the field
  double uniformity = 0;        // minimum / maximum
  double uniformity_sigma = 0;  // from the sigmas of both, as if independent
};

struct UniformityMap {
  PixelPoint reference;
  double reference_luminance = 0;        // mean over the reference disk, unit of the input
  double reference_luminance_sigma = 0;  // without the scale's, which cancels in g
  MeasuredImage raw;                     // g = L(x) / L(reference), unit "1"
  Image<float> scatter_sigma;  // of raw, see LuminanceImage, and part of its variance; may be empty
  FieldChoice choice;          // how the smooth models were chosen
  int polynomial_order = 0;    // of the smooth models that were fitted
  bool polynomial_weighted = false;
  int spline_intervals = 0;                // 0 where no spline is determined
  SmoothField smooth;                      // 1 at the reference point: the one that predicts better
  std::optional<SmoothField> alternative;  // likewise, of the other kind, where it is determined
  AreaUniformity area;
  FieldRange raw_range;              // over valid pixels
  FieldRange smooth_range;           // over valid pixels
  double residual_rms = 0;           // raw - smooth
  double residual_rms_expected = 0;  // what the noise of raw alone would leave
  PointUniformity nine_points;
  PointUniformity thirteen_points;
  std::vector<PatchRatio> g_of_nine_points;      // 1 at the reference disk; in the patches' order
  std::vector<PatchRatio> g_of_thirteen_points;  // likewise
};

// Errors: InvalidArgument (reference outside the image; order or intervals out of range),
// FailedPrecondition
// (no valid pixel in the reference disk or a patch, its luminance is not above 0 by 5 sigma, fewer
// valid pixels than coefficients).
absl::StatusOr<UniformityMap> MeasureUniformity(const LuminanceImage& full_field,
                                                const UniformityOptions& options = {});

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_UNIFORMITY_UNIFORMITY_MAP_H_
