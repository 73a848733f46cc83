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

// Factor on the covariance: what the residuals show beyond the stated sigmas, 1 where chance (3
// standard deviations of chi-square) explains it.
double ExcessScatter(double chi_square, int degrees_of_freedom);

// Takes the sigmas of the parameters and of the glare from the covariance.
void StateSigmas(ScatterFit& fit);

// An error that moves all parameters together by this at 1 standard deviation.
void AddToCovariance(const std::array<double, kGlareParameters>& moved, ScatterFit& fit);

}  // namespace eyebox::fit

#endif  // EYEBOX_FIT_SCATTER_GLARE_COVARIANCE_H_
