// How the light of a display drifted while it was measured, from patches that were read again and
// again: a polynomial in time of order 0, 1 or 2, whichever the readings bear out.
#ifndef EYEBOX_OPTICS_PHOTOMETRY_DRIFT_H_
#define EYEBOX_OPTICS_PHOTOMETRY_DRIFT_H_

#include <span>

#include "absl/status/statusor.h"
#include "optics/photometry/luminance_image.h"

namespace eyebox::optics {

struct DriftReading {
  double time_s = 0;  // of any clock that does not jump
  double value = 0;   // any unit that is proportional to light, above 0
  double sigma = 0;   // standard uncertainty of its own, above 0
  int series = 0;     // readings of one patch by one instrument: their level is one unknown
};

// factor(t) = 1 + linear x + quadratic x^2, x = (t - middle_s) / half_span_s: what the display gave
// at t, relative to the mean time of the readings. Inside the readings x is -1 to 1 or a little
// more.
struct Drift {
  int order = 0;        // 0: no drift is borne out, both coefficients are 0
  double first_s = 0;   // time of the first reading; the last is 2 half_span_s later
  double middle_s = 0;  // mean of all
  double half_span_s = 1;
  double linear = 0;
  double quadratic = 0;
  // Of the coefficients; with order 0 that of a straight line, which bounds what stayed unseen.
  double linear_variance = 0;
  double quadratic_variance = 0;
  double covariance = 0;
  // The straight line that fits best, whether borne out or not.
  double per_hour = 0;
  double per_hour_sigma = 0;
  double reduced_chi2 = 0;  // of the order that was chosen
  int readings = 0;

  double FactorAt(double time_s) const;
  // Standard uncertainty of FactorAt(). With order 0 it is 0: nothing is corrected.
  double SigmaAt(double time_s) const;
  // Largest less smallest factor between the first reading and the last.
  double Span() const;
};

// Weighted least squares of value = level of its series times factor(t). Where the readings scatter
// by more than their sigmas say, the scatter counts. An order is borne out if its highest
// coefficient differs from 0 at 99.73 % by Student's t (GUM, table G.2). Order 1 needs 2 readings
// more than there are series, order 2 needs 4.
// Errors: InvalidArgument (too few readings, one that is not finite or not above 0, no series with
// readings of two times).
absl::StatusOr<Drift> FitDrift(std::span<const DriftReading> readings);

// Divides by the factor at `time_s`. The uncertainty of the factor is common to all pixels: it adds
// to scale_relative_sigma, not to the variance of pixels. With order 0 nothing changes.
void CorrectDrift(const Drift& drift, double time_s, LuminanceImage& image);

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_PHOTOMETRY_DRIFT_H_
