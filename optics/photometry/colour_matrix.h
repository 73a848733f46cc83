// From three signals (filters, or the colours of a Bayer sensor) to tristimulus values.
#ifndef EYEBOX_OPTICS_PHOTOMETRY_COLOUR_MATRIX_H_
#define EYEBOX_OPTICS_PHOTOMETRY_COLOUR_MATRIX_H_

#include <array>
#include <span>
#include <vector>

#include "absl/status/statusor.h"

namespace eyebox::optics {

// Light whose tristimulus values are known.
struct ColourSample {
  std::array<double, 3> signal = {};     // red, green, blue; DN/s, taken as exact
  std::array<double, 3> xyz = {};        // cd/m2 or relative
  std::array<double, 3> xyz_sigma = {};  // same unit; 0 in any sample: no weights, see below
};

// XYZ = matrix (red, green, blue[, 1]).
struct ColourMatrix {
  int columns = 3;             // 3, or 4 with a constant
  std::vector<double> matrix;  // [3, columns], row-major
  // Of the coefficients of each row: [3, columns, columns].
  std::vector<double> covariance;
  // rms error of left-out samples in units of the largest Y; NaN where there are too few samples.
  double leave_one_out_rms_3 = 0;
  double leave_one_out_rms_4 = 0;

  std::array<double, 3> Xyz(const std::array<double, 3>& signal) const;
  // Standard uncertainties of Xyz(), of the matrix alone.
  std::array<double, 3> XyzSigma(const std::array<double, 3>& signal) const;
};

// Weighted least squares, a row at a time; without sigmas the weights are equal and the scatter
// gives the covariance. The constant is kept where it lowers the leave-one-out error.
// Errors: InvalidArgument (fewer than 4 samples, not finite, a negative sigma), FailedPrecondition
// (the lights do not tell the three signals apart).
absl::StatusOr<ColourMatrix> FitColourMatrix(std::span<const ColourSample> samples);

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_PHOTOMETRY_COLOUR_MATRIX_H_
