// What the fitted instrument reads of a patch, and how that answers to the patch's own luminance
// (Murray, Patel & Wiedenmann 2022, eq 5 to 9, fig 6).
#ifndef EYEBOX_FIT_SCATTER_PREDICT_READINGS_H_
#define EYEBOX_FIT_SCATTER_PREDICT_READINGS_H_

#include <span>
#include <vector>

#include "absl/status/statusor.h"
#include "fit/scatter/fit_scatter.h"

namespace eyebox::fit {

// p = slope p* + offset, with p* what an ideal instrument would read in the middle of the patch:
// its own luminance. The offset is light scattered from the background, whatever the patch shows:
// 0 only where no background is left, which makes p proportional to p*.
struct PredictedReading {
  double diameter_deg = 0;
  double slope = 0;
  double slope_sigma = 0;
  double offset = 0;  // unit of the series
  double offset_sigma = 0;
  double reading = 0;  // p of a disk of the fitted bright luminance on the fitted background
  double reading_sigma = 0;
};

// Disks of these diameters on the axis, and then the whole field (diameter: that of the field).
// Standard uncertainties from the covariance of the fit, to first order; that of the instrument is
// in it where it was given. Errors: InvalidArgument (a diameter not above 0 or not finite).
absl::StatusOr<std::vector<PredictedReading>> PredictReadings(
    const ScatterFit& fit, const ScatterFitOptions& options, double field_radius_deg,
    std::span<const double> diameters_deg);

}  // namespace eyebox::fit

#endif  // EYEBOX_FIT_SCATTER_PREDICT_READINGS_H_
