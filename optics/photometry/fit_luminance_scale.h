// The luminance of 1 DN/s, from known luminances on a flat reference display.
#ifndef EYEBOX_OPTICS_PHOTOMETRY_FIT_LUMINANCE_SCALE_H_
#define EYEBOX_OPTICS_PHOTOMETRY_FIT_LUMINANCE_SCALE_H_

#include <span>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "optics/photometry/luminance_image.h"

namespace eyebox::optics {

// A luminance that a meter read and what the camera made of the same light.
struct ScaleReading {
  double luminance_cd_m2 = 0;  // at least 0
  double luminance_sigma = 0;  // repeatability of the meter, cd/m2; its calibration is apart
  double reading = 0;          // DN/s, or counts of a photodiode
  double reading_sigma = 0;    // same unit; one of the two sigmas must be above 0
};

struct LuminanceScaleOptions {
  // Relative standard uncertainty of the meter's calibration, common to all its readings.
  double meter_relative_sigma = 0;
  // An intercept less probable than this is one, and the scale is not accepted.
  double intercept_probability = 0.01;
  // Scatter less probable than this widens the uncertainty, with a warning.
  double scatter_probability = 0.01;
};

struct LuminanceScaleFit {
  KnownLuminance per_unit;           // of 1 DN/s, the meter's uncertainty included
  double fit_relative_sigma = 0;     // of the fit alone
  double intercept_cd_m2 = 0;        // of the line with an intercept
  double intercept_sigma_cd_m2 = 0;  //
  double intercept_p_value = 1;      // two-sided, if there were none
  double slope_with_intercept = 0;   // cd/m2 per DN/s
  double slope_with_intercept_sigma = 0;
  double reduced_chi2 = 0;  // of the line through the origin
  double chi2_p_value = 1;
  std::vector<double> fitted_cd_m2;  // a reading each, of the line through the origin
  bool accepted = false;
  std::vector<std::string> reasons;  // why not
  std::vector<std::string> warnings;
};

// L = s r through the origin, and L = s r + b for the test: weighted least squares with effective
// variances sigma_L^2 + s^2 sigma_r^2 (Orear 1982). An intercept says that the black level, stray
// light or a wrong dark is in the readings, and that no scale serves the whole range.
// Errors: InvalidArgument (fewer than 3 readings, or of one luminance only; a number that is not
// finite, a negative luminance or sigma, both sigmas 0; a slope that is not above 0).
absl::StatusOr<LuminanceScaleFit> FitLuminanceScale(std::span<const ScaleReading> readings,
                                                    const LuminanceScaleOptions& options = {});

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_PHOTOMETRY_FIT_LUMINANCE_SCALE_H_
