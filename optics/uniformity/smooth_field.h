// A smooth function over the image, with the covariance of its coefficients.
#ifndef EYEBOX_OPTICS_UNIFORMITY_SMOOTH_FIELD_H_
#define EYEBOX_OPTICS_UNIFORMITY_SMOOTH_FIELD_H_

#include <optional>
#include <vector>

#include "absl/status/statusor.h"
#include "capture/base/image.h"
#include "optics/reduce/measured_image.h"
#include "optics/uniformity/field_basis.h"

namespace eyebox::optics {

// Sum of coefficients times the functions of FieldBasis(model, order, size), in the order of its
// terms.
struct SmoothField {
  ImageSize size;
  FieldModel model = FieldModel::kPolynomial;
  int order = 0;                     // of a spline: intervals along the longer side
  std::vector<double> coefficients;  // n; of a polynomial (order + 1) (order + 2) / 2
  std::vector<double> covariance;    // [n, n] row-major
  double reduced_chi2 = 0;  // of the fit; above 1 the covariance of noise has been scaled by it
  // How many coefficients the pixels determine: all of them unless their orders were weighted.
  double effective_functions = 0;

  double At(double x_px, double y_px) const;
  double SigmaAt(double x_px, double y_px) const;  // standard uncertainty
  // Whole maps, [height, width].
  Image<float> Values() const;
  Image<float> Sigmas() const;
};

// Least squares weighted with 1/variance over the valid pixels. `shared_sigma`, unless empty, is an
// error that all pixels share, as LuminanceImage::scatter_sigma: it passes through the same fit.
// Errors: InvalidArgument (order outside 0 to kLargestOrder, intervals outside 1 to
// kMostIntervals), FailedPrecondition
// (fewer valid pixels than coefficients, or a singular system: a function without a valid pixel).
// `larger_order` tells what the model leaves out: where that one takes more out of the residuals
// than noise would leave, the covariance of noise is scaled by how much more.
absl::StatusOr<SmoothField> FitSmoothField(const MeasuredImage& image, FieldModel model, int order,
                                           const Image<float>& shared_sigma = {},
                                           std::optional<int> larger_order = {});

// The polynomial of all orders to `largest_order`, each weighted as OrderPenalties() tells. Its
// covariance is that of the posterior, so that what the weights keep back is counted.
// Errors: as FitSmoothField().
absl::StatusOr<SmoothField> FitWeightedPolynomial(const MeasuredImage& image, int largest_order,
                                                  const Image<float>& shared_sigma = {});

// Divided by its value at a point, which becomes 1 with no uncertainty.
// Errors: FailedPrecondition (value there not above 0).
absl::StatusOr<SmoothField> NormaliseAt(const SmoothField& field, double x_px, double y_px);

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_UNIFORMITY_SMOOTH_FIELD_H_
