// How much of the field a pixel covers.
#ifndef EYEBOX_OPTICS_GEOMETRY_SOLID_ANGLE_H_
#define EYEBOX_OPTICS_GEOMETRY_SOLID_ANGLE_H_

#include "absl/status/statusor.h"
#include "capture/base/image.h"
#include "optics/geometry/camera_model.h"

namespace eyebox::optics {

// sr of each pixel, [height, width]: the spherical quadrilateral between the directions of its four
// corners (Van Oosterom and Strackee 1983), so that neighbours neither overlap nor leave a gap and
// the sum over a region depends on its outline alone. For a pinhole without distortion each is
// exact to 1e-9 relative. NaN where a corner sees nothing.
// Errors: those of CameraModel::Validate().
absl::StatusOr<Image<double>> PixelSolidAnglesSr(const CameraModel& model);

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_GEOMETRY_SOLID_ANGLE_H_
