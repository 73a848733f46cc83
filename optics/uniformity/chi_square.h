// The chi-square distribution.
#ifndef EYEBOX_OPTICS_UNIFORMITY_CHI_SQUARE_H_
#define EYEBOX_OPTICS_UNIFORMITY_CHI_SQUARE_H_

namespace eyebox::optics {

// Chance of a chi-square of at least this, with that many degrees of freedom (above 0, whole or
// not): the regularised upper incomplete gamma function Q(dof / 2, chi2 / 2). To 1e-12 relative
// where it is above 1e-300; 1 for a chi2 not above 0.
double ChiSquareSurvival(double chi2, double degrees_of_freedom);

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_UNIFORMITY_CHI_SQUARE_H_
