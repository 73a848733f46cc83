// Counts of a photodiode to cd/m2, learnt from known luminances.
#ifndef EYEBOX_OPTICS_PHOTOMETRY_PHOTODIODE_SCALE_H_
#define EYEBOX_OPTICS_PHOTOMETRY_PHOTODIODE_SCALE_H_

#include <span>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "optics/photometry/fit_luminance_scale.h"
#include "optics/photometry/monotone_curve.h"

namespace eyebox::optics {

// In which the curve is a piecewise cubic.
enum class PhotodiodeAxes {
  kLinear,     // counts, luminance
  kLogLog,     // logarithms of both: a response that is nearly a power, over many decades
  kLinearLog,  // counts, logarithm of luminance: a logarithmic amplifier
};

// "linear", "log_log", "linear_log".
const char* NameOf(PhotodiodeAxes axes);

// Rising or falling throughout.
class PhotodiodeScale {
 public:
  // Errors: those of MonotoneCurve::Through; InvalidArgument (logarithm of what is not above 0).
  static absl::StatusOr<PhotodiodeScale> Through(PhotodiodeAxes axes,
                                                 std::span<const double> counts,
                                                 std::span<const double> luminance_cd_m2);

  // Errors: OutOfRange (counts beyond those of the known luminances; says which there are).
  absl::StatusOr<double> LuminanceOf(double counts) const;
  absl::StatusOr<double> CountsOf(double luminance_cd_m2) const;

  PhotodiodeAxes Axes() const { return axes_; }
  std::span<const double> Counts() const { return counts_; }  // knots, rising
  std::span<const double> LuminanceCdM2() const { return luminance_cd_m2_; }

 private:
  PhotodiodeScale(PhotodiodeAxes axes, bool falls, MonotoneCurve curve)
      : axes_(axes), falls_(falls), curve_(std::move(curve)) {}

  PhotodiodeAxes axes_;
  bool falls_;           // the curve is one of the negative logarithm, or luminance, then
  MonotoneCurve curve_;  // counts to luminance, on the axes
  std::vector<double> counts_, luminance_cd_m2_;
};

struct PhotodiodeFit {
  PhotodiodeScale scale;
  double leave_one_out_rms_relative = 0;  // inner knots, each predicted without itself
  double relative_sigma = 0;              // that and the meter's calibration
  int pooled = 0;                         // readings that noise had put in the wrong order
  // A knot each; NaN at both ends, and where luminance is 0.
  std::vector<double> leave_one_out_relative;
  std::vector<std::string> warnings = {};
};

// The axes with the least leave-one-out error. Readings out of order are pooled (isotonic
// regression of counts over luminance) before the curve is drawn.
// Errors: InvalidArgument (fewer than 4 readings, not finite, a negative luminance, fewer than 4
// that differ), FailedPrecondition (more than half of the readings had to be pooled: counts do not
// follow luminance).
absl::StatusOr<PhotodiodeFit> FitPhotodiode(std::span<const ScaleReading> readings,
                                            double meter_relative_sigma);

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_PHOTOMETRY_PHOTODIODE_SCALE_H_
