// Least squares over a lens and the poses of its views (bundle adjustment of a flat target).
#ifndef EYEBOX_OPTICS_GEOMETRY_REFINE_LENS_H_
#define EYEBOX_OPTICS_GEOMETRY_REFINE_LENS_H_

#include <array>
#include <span>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "optics/geometry/camera_model.h"
#include "optics/geometry/lens.h"
#include "optics/geometry/pose.h"
#include "optics/geometry/view_points.h"

namespace eyebox::optics {

struct LensEstimate {
  CameraModel model;
  std::vector<Pose> poses;  // one a view
};

struct RefinedLens {
  LensEstimate estimate;
  double sum_of_squares_px2 = 0;
  // 9 x 9, row-major: (J^T J)^-1 of the lens, times the residual variance; zeros where held.
  std::vector<double> covariance;
  int iterations = 0;
  std::string termination;
};

// Sum of squared distances; infinite where a point has no image.
double SumOfSquaresPx2(std::span<const ViewPoints> views, const LensEstimate& estimate);

// Levenberg-Marquardt with exact derivatives. `is_free` says which of fx, fy, cx, cy and the
// distortion may move.
// Errors: FailedPrecondition (the start does not see all points, the normal equations are singular,
// the search does not settle in 200 steps).
absl::StatusOr<RefinedLens> RefineLens(std::span<const ViewPoints> views, LensEstimate start,
                                       const std::array<bool, kLensParameters>& is_free);

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_GEOMETRY_REFINE_LENS_H_
