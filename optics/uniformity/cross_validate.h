// Which smooth model of a field predicts best the pixels that it was not fitted to.
#ifndef EYEBOX_OPTICS_UNIFORMITY_CROSS_VALIDATE_H_
#define EYEBOX_OPTICS_UNIFORMITY_CROSS_VALIDATE_H_

#include <vector>

#include "absl/status/statusor.h"
#include "optics/reduce/measured_image.h"
#include "optics/uniformity/field_basis.h"

namespace eyebox::optics {

struct CrossValidated {
  FieldModel model = FieldModel::kPolynomial;
  int size = 0;  // order or intervals
  // Mean over the held-out pixels of (value - prediction)^2 / variance: 1 and the error of the
  // fit where the noise is as stated and the model holds.
  double held_out_chi2 = 0;
};

struct FieldChoice {
  std::vector<CrossValidated> polynomials;  // order 0 and up, as far as the pixels determine them
  std::vector<CrossValidated> splines;      // 1, 2, 3, 4, 6, 8, 12, 16 intervals, likewise
  CrossValidated polynomial;                // the best of each
  CrossValidated spline;
  CrossValidated weighted;  // the largest of the polynomials, its orders weighted (order_weights.h)
  bool spline_is_better = false;  // than the weighted polynomial
};

// Five classes of pixels, spread evenly, are predicted from the other four. Works on blocks of
// pixels where a side is longer than 384 pixels; masked pixels do not count.
// Errors: FailedPrecondition (no model is determined: too few valid pixels).
absl::StatusOr<FieldChoice> CrossValidate(const MeasuredImage& image);

// Means of blocks of `block_px` pixels, weighted alike, of their valid pixels; masked where there
// is none. Blocks at the right and lower rim may be cut. Errors: none; block_px is at least 1.
MeasuredImage Binned(const MeasuredImage& image, int block_px);

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_UNIFORMITY_CROSS_VALIDATE_H_
