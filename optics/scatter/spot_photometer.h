// A spot photometer aimed at a display: what it reads, and what an ideal one would
// (Murray, Patel & Wiedenmann 2022, appendix A).
#ifndef EYEBOX_OPTICS_SCATTER_SPOT_PHOTOMETER_H_
#define EYEBOX_OPTICS_SCATTER_SPOT_PHOTOMETER_H_

#include "absl/status/statusor.h"
#include "capture/base/image.h"
#include "optics/scatter/scatter_kernel.h"

namespace eyebox::optics {

struct SpotPhotometer {
  ScatterKernel weight;            // w; its core is the target, usually a disk
  double target_diameter_deg = 1;  // nominal
};

// A disk on the axis, in the middle of a display of this radius. A black disk on a bright field has
// its dark luminance in `disk_luminance`.
struct DiskScene {
  double diameter_deg = 0;
  double disk_luminance = 0;  // any unit, also of the result
  double surround_luminance = 0;
  double field_radius_deg = 50;
};

// p = integral of w I. Closed form. Errors: InvalidArgument (kernel, negative diameter or radius,
// luminance not finite).
absl::StatusOr<double> ReadDisk(const SpotPhotometer& photometer, const DiskScene& scene);

// The same over a scene on a grid of field angles, aimed at the middle of pixel (x_px, y_px); the
// scene is dark outside (eq 4).
// Errors: InvalidArgument (kernel, pitch, aim outside the scene, pixel not finite).
absl::StatusOr<double> ReadScene(const SpotPhotometer& photometer, const Image<float>& scene,
                                 double pitch_deg, int x_px, int y_px);
// p*: the mean of the scene over the nominal target, pixels by the share of them that it covers
// (eq 3). Errors: those of ReadScene; the target must lie within the scene.
absl::StatusOr<double> ReadSceneIdeally(const SpotPhotometer& photometer, const Image<float>& scene,
                                        double pitch_deg, int x_px, int y_px);

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_SCATTER_SPOT_PHOTOMETER_H_
