// The exponent that serves all locations best, found on the matrix of their products.
#ifndef EYEBOX_FIT_FIELD_EXPONENT_SEARCH_H_
#define EYEBOX_FIT_FIELD_EXPONENT_SEARCH_H_

#include <span>

namespace eyebox::fit {

struct ExponentProblem {
  std::span<const double> drives;    // [levels]
  std::span<const double> weights;   // [levels], of squared residuals
  std::span<const double> products;  // [levels, levels], S = Y^T Y without weights
  double gamma_min = 0;
  double gamma_max = 0;
};

struct ExponentOptimum {
  double gamma = 0;
  bool at_limit = false;      // the sum of squares still falls at gamma_min or gamma_max
  double sum_of_squares = 0;  // at gamma, with the digits that the difference of two sums leaves
  double curvature = 0;       // second derivative of the sum of squares
  int evaluations = 0;
};

// Scans for the deepest valley of the sum of squares, then halves the interval in which its slope
// changes sign: a search by values alone would stop at half of the digits.
ExponentOptimum FindExponent(const ExponentProblem& problem);

}  // namespace eyebox::fit

#endif  // EYEBOX_FIT_FIELD_EXPONENT_SEARCH_H_
