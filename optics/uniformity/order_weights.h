// How far the orders of a polynomial over a field are to be trusted: instead of cutting it off at
// one of them, each coefficient is drawn towards 0 as far as those of its order are small.
#ifndef EYEBOX_OPTICS_UNIFORMITY_ORDER_WEIGHTS_H_
#define EYEBOX_OPTICS_UNIFORMITY_ORDER_WEIGHTS_H_

#include <vector>

#include "optics/uniformity/field_basis.h"
#include "optics/uniformity/normal_equations.h"

namespace eyebox::optics {

// Fewer orders than this do not tell how their coefficients fall off: all are then taken as they
// are.
inline constexpr int kLeastWeightedOrder = 4;

// Empirical Bayes. The coefficients of order d >= 1, of functions with a root mean square of 1, are
// taken as drawn from a normal distribution of mean 0 and variance A exp(-b d) + B d^-4: smooth
// fields fall off exponentially, and a kink at the rim of the image leaves a power of the order.
// A, b and B make the measured coefficients most likely (type-II maximum likelihood). Returns what
// is to be added to the diagonal of the normal equations, [terms], 0 for the mean: noise variance
// over that variance. `equations` are of a polynomial basis, all of whose terms they determine.
std::vector<double> OrderPenalties(const NormalEquations& equations, const FieldBasis& basis);

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_UNIFORMITY_ORDER_WEIGHTS_H_
