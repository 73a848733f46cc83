// Luminance against the distance from a point, for readings around a small source.
#ifndef EYEBOX_OPTICS_SCATTER_RADIAL_PROFILE_H_
#define EYEBOX_OPTICS_SCATTER_RADIAL_PROFILE_H_

#include <cstddef>
#include <span>
#include <vector>

#include "absl/status/statusor.h"
#include "optics/reduce/measured_image.h"

namespace eyebox::optics {

struct RadialReading {
  double offset_deg = 0;  // root mean square distance of the pixels from the centre
  // (mean of 1 / distance^2)^(-1/2): where a tail that falls as its inverse square or a little
  // faster has the mean of the ring; 0 if the ring holds the centre itself.
  double tail_offset_deg = 0;
  double value = 0;  // mean, unit of the image
  double sigma = 0;  // of noise alone
  size_t pixels = 0;
};

// Mean over the valid pixels of each ring edges[k] <= r < edges[k + 1] around the point; rings
// without any are left out. `image` lies on a grid of equal steps in field angle.
// Errors: InvalidArgument (pitch, fewer than 2 edges or not ascending from 0 or more),
// FailedPrecondition (no valid pixel in any ring).
absl::StatusOr<std::vector<RadialReading>> MeasureRadialProfile(const MeasuredImage& image,
                                                                double x_px, double y_px,
                                                                double pitch_deg,
                                                                std::span<const double> edges_deg);

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_SCATTER_RADIAL_PROFILE_H_
