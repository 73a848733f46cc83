// Sums over an image from which every least-squares fit of a field basis follows.
#ifndef EYEBOX_OPTICS_UNIFORMITY_NORMAL_EQUATIONS_H_
#define EYEBOX_OPTICS_UNIFORMITY_NORMAL_EQUATIONS_H_

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "optics/reduce/measured_image.h"
#include "optics/uniformity/field_basis.h"

namespace eyebox::optics {

// Over valid pixels, each with the weight 1/variance.
struct NormalEquations {
  std::vector<double> matrix;      // [n, n], symmetric: sum of w basis_i basis_j
  std::vector<double> right_side;  // [n]: sum of w value basis_i
  double squares = 0;              // sum of w value^2
  size_t pixels = 0;

  NormalEquations& operator+=(const NormalEquations& other);
  NormalEquations& operator-=(const NormalEquations& other);
  // Sum of w (value - model)^2 of the first coefficients of the basis.
  double Chi2(std::span<const double> coefficients) const;
};

// One for each of `folds` classes of pixels that are spread evenly over the image; their sum is
// that of all pixels.
std::vector<NormalEquations> SumImage(const MeasuredImage& image, const FieldBasis& basis,
                                      int folds);

// Coefficients of the first `terms` functions with the least Chi2() plus penalty times square;
// penalties: one for each of them, or none. nullopt where the matrix does not determine them: not
// positive, or a reciprocal condition below 1e-13.
std::optional<std::vector<double>> Minimise(const NormalEquations& equations, size_t terms,
                                            const std::vector<double>& penalties);

struct Minimum {
  std::vector<double> coefficients;
  std::vector<double> inverse;  // [n, n], symmetric: of the matrix with its penalties
};

// The same of all functions.
std::optional<Minimum> MinimiseWithInverse(const NormalEquations& equations,
                                           const std::vector<double>& penalties);

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_UNIFORMITY_NORMAL_EQUATIONS_H_
