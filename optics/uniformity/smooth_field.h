// A smooth function over the image: a 2-D polynomial with the covariance of its coefficients.
#ifndef EYEBOX_OPTICS_UNIFORMITY_SMOOTH_FIELD_H_
#define EYEBOX_OPTICS_UNIFORMITY_SMOOTH_FIELD_H_

#include <vector>

#include "absl/status/statusor.h"
#include "capture/base/image.h"
#include "optics/reduce/measured_image.h"

namespace eyebox::optics {

// Sum over a, b with a + b <= order of c_ab P_a(x') P_b(y'), P the Legendre polynomials, x' and y'
// running from -1 to 1 over the image. Coefficients in the order (0,0), (1,0), (0,1), (2,0), ...
struct SmoothField {
  ImageSize size;
  int order = 0;
  std::vector<double> coefficients;  // n = (order + 1) (order + 2) / 2
  std::vector<double> covariance;    // [n, n] row-major
  double reduced_chi2 = 0;           // of the fit; above 1 the covariance has been scaled by it

  double At(double x_px, double y_px) const;
  double SigmaAt(double x_px, double y_px) const;  // standard uncertainty
  // Whole maps, [height, width].
  Image<float> Values() const;
  Image<float> Sigmas() const;
};

// Least squares weighted with 1/variance over the valid pixels.
// Errors: InvalidArgument (order outside 0 to 8), FailedPrecondition (fewer valid pixels than
// coefficients, or a singular system: all valid pixels on a line).
absl::StatusOr<SmoothField> FitSmoothField(const MeasuredImage& image, int order);

// Divided by its value at a point, which becomes 1 with no uncertainty.
// Errors: FailedPrecondition (value there not above 0).
absl::StatusOr<SmoothField> NormaliseAt(const SmoothField& field, double x_px, double y_px);

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_UNIFORMITY_SMOOTH_FIELD_H_
