// How far the parameters of a fit are entangled.
#ifndef EYEBOX_FIT_BASE_CONDITIONING_H_
#define EYEBOX_FIT_BASE_CONDITIONING_H_

#include <span>

namespace eyebox::fit {

// Largest over smallest eigenvalue of the correlations among the estimates: the condition number of
// the normal matrix, scaled so that its inverse has a diagonal of 1, which takes the units of the
// parameters out. 1 where they are independent; its square root is about the factor by which a
// combination of parameters is known worse than each by itself.
// `covariance` is [parameters, parameters]; parameters of variance 0 (held) are left out. Infinite
// where the others depend on each other within rounding; 1 for fewer than two.
double ConditionNumber(std::span<const double> covariance);

}  // namespace eyebox::fit

#endif  // EYEBOX_FIT_BASE_CONDITIONING_H_
