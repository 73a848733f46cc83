// How often chance alone gives an F as large.
#ifndef EYEBOX_FIT_FIELD_F_DISTRIBUTION_H_
#define EYEBOX_FIT_FIELD_F_DISTRIBUTION_H_

namespace eyebox::fit {

// P(F >= f) with the given degrees of freedom (above 0, to 1e9), by the continued fraction of the
// incomplete beta function (NIST DLMF 8.17.22). 1 for f <= 0. Relative error below 1e-7 where the
// result is above 1e-250.
double FTail(double f, double numerator_freedom, double denominator_freedom);

}  // namespace eyebox::fit

#endif  // EYEBOX_FIT_FIELD_F_DISTRIBUTION_H_
