// How sure the colour of a fitted display is.
#ifndef EYEBOX_FIT_COLOR_COLOUR_SIGMA_H_
#define EYEBOX_FIT_COLOR_COLOUR_SIGMA_H_

#include <span>

#include "fit/color/colour_model.h"

namespace eyebox::fit {

// Standard uncertainties of X, Y and Z at `drive`, from the covariance of the parameters
// (row-major, [n, n], in the order of ParameterNames): the band of a prediction, without the noise
// of a new reading. Exact derivatives; finite for every drive.
Xyz ColourSigma(const ColourModel& model, std::span<const double> covariance, const Rgb& drive);

}  // namespace eyebox::fit

#endif  // EYEBOX_FIT_COLOR_COLOUR_SIGMA_H_
