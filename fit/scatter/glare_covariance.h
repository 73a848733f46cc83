// What the readings determine and what they leave open.
#ifndef EYEBOX_FIT_SCATTER_GLARE_COVARIANCE_H_
#define EYEBOX_FIT_SCATTER_GLARE_COVARIANCE_H_

#include <array>
#include <string>
#include <vector>

#include "fit/scatter/glare_model.h"

namespace eyebox::fit {

struct GlareUncertainty {
  // [7, 7] row-major of the values; zeros for held parameters.
  std::array<double, kGlareParameters * kGlareParameters> covariance{};
  std::vector<OpenCombination> open;
  std::string identifiability;
};

// From the singular values of the Jacobian of the residuals by the coordinates. `scale` multiplies
// what comes from the readings; the uncertainty of a known instrument is added. A direction that
// changes no reading gets a sigma that is huge, but finite.
GlareUncertainty MeasureUncertainty(const GlareModel& model, const GlareCoordinates& optimum,
                                    double scale);

}  // namespace eyebox::fit

#endif  // EYEBOX_FIT_SCATTER_GLARE_COVARIANCE_H_
