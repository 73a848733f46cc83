// A lens from views of a flat target whose points are known.
#ifndef EYEBOX_OPTICS_GEOMETRY_CALIBRATE_LENS_H_
#define EYEBOX_OPTICS_GEOMETRY_CALIBRATE_LENS_H_

#include <array>
#include <span>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "capture/base/image.h"
#include "optics/geometry/camera_model.h"
#include "optics/geometry/view_points.h"

namespace eyebox::optics {

struct LensCalibrationOptions {
  LensModel lens = LensModel::kPinhole;
  // How many of the distortion coefficients are free, in their order; the others stay 0. At most 5
  // of a pinhole (k1 k2 p1 p2 k3), 4 of an equidistant lens.
  int distortion_terms = 4;
  // What a calibration must reach to be accepted.
  double largest_rms_px = 0.5;
  double largest_focal_length_sigma_relative = 0.01;
};

struct ViewResidual {
  std::string source;
  int points = 0;
  double rms_px = 0;    // of the distances between found and predicted points
  double tilt_deg = 0;  // between the normal of the target and the camera's axis
};

struct LensCalibration {
  CameraModel model;
  // fx, fy, cx, cy, then the distortion: standard uncertainties, from the scatter of the residuals;
  // 0 for what was held. `covariance` is 9 x 9, row-major, in the same order.
  std::array<double, 9> sigma = {};
  std::vector<double> covariance;
  double rms_px = 0;  // over all views, as in ViewResidual
  int points = 0;
  std::vector<ViewResidual> views;
  bool accepted = false;
  std::vector<std::string> reasons;   // why it was not accepted
  std::vector<std::string> warnings;  // what should be looked at
  int iterations = 0;
  std::string termination;  // why the search stopped
};

// Least squares over lens and poses, all points with one weight. A pinhole starts from
// cv::calibrateCamera, an equidistant lens from the best of a range of focal lengths.
// Errors: InvalidArgument (no size, terms out of range, a point that is not finite, fewer than 3
// views, a view with fewer than 6 points or with all of them on a line), FailedPrecondition (the
// views do not determine the lens, or the search finds no start or does not settle).
absl::StatusOr<LensCalibration> CalibrateLens(std::span<const ViewPoints> views, ImageSize size,
                                              const LensCalibrationOptions& options = {});

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_GEOMETRY_CALIBRATE_LENS_H_
