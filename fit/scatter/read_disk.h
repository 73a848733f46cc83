// From the image of a disk to readings that tell how light scatters: the middle of the disk, and
// rings around it.
#ifndef EYEBOX_FIT_SCATTER_READ_DISK_H_
#define EYEBOX_FIT_SCATTER_READ_DISK_H_

#include <vector>

#include "absl/status/statusor.h"
#include "fit/scatter/glare_series.h"
#include "optics/geometry/pixel_point.h"
#include "optics/reduce/calibration.h"
#include "optics/reduce/measured_image.h"

namespace eyebox::fit {

struct DiskReadingOptions {
  double spot_radius_px = 1;  // around the axis, in the middle of each disk
  // Rings of this ratio of radii around a bright disk, from its edge and `ring_guard_px` on.
  double ring_ratio = 1.1;
  double ring_guard_px = 3;  // away from the edge, where the core blurs it
  // What the model leaves out (g between its rings, light beside the image), relative to each
  // reading. It also stands for the flat's error in rings of the same radius, which images share.
  double model_relative_sigma = 0.0002;

  // Errors: InvalidArgument naming the option.
  absl::Status Validate() const;
};

// Where disks stand, on a grid of equal steps in field angle.
struct DiskAim {
  optics::PixelPoint axis;
  double pitch_deg = 0;
};

// The middle of the disk; of a bright one with a diameter above 0 also the rings that fit into the
// image. The flat's error in the middle is the same in every image: one error that they share; in
// rings it counts as noise.
// Errors: InvalidArgument (options, pitch), FailedPrecondition (no valid pixel in the middle).
absl::StatusOr<std::vector<GlareReading>> ReadDisk(const optics::MeasuredImage& image,
                                                   const optics::Calibration& calibration,
                                                   const DiskAim& aim, GlarePattern pattern,
                                                   double diameter_deg,
                                                   const DiskReadingOptions& options = {});

}  // namespace eyebox::fit

#endif  // EYEBOX_FIT_SCATTER_READ_DISK_H_
