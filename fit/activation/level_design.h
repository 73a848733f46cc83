// At which drive values, and for how long, a display should be measured.
#ifndef EYEBOX_FIT_ACTIVATION_LEVEL_DESIGN_H_
#define EYEBOX_FIT_ACTIVATION_LEVEL_DESIGN_H_

#include <span>
#include <vector>

#include "absl/status/statusor.h"
#include "fit/activation/fit_activation.h"

namespace eyebox::fit {

// A drive value that may be measured.
struct LevelCandidate {
  double drive = 0;
  double frame_sigma = 0;  // of the luminance that one frame of each exposure gives
  double frame_time_s = 0;
};

// Relative errors at values u, fractions of white above the display's minimum, through a table that
// is exact for the fit.
enum class ErrorAtU {
  kLuminance,  // of the luminance at u
  kDeparture,  // of the luminance at u over u times that at white: how far from proportional
};

// d(error at u) / d(parameter), in the order of ActivationFit::parameters: what is shown over what
// is wanted, less 1, where the fit is off by a little.
std::vector<double> ErrorGradient(const ActivationFit& fit, ErrorAtU error, double u);

// Variances of that error at each of `u`, from the covariance of `fit`.
std::vector<double> ErrorVariances(const ActivationFit& fit, ErrorAtU error,
                                   std::span<const double> u);

// Shares of the time, [candidates], summing to 1, that make the mean of the error's variance over
// `u` smallest for the time spent (I-optimality under cost), for an activation like that of `fit`:
// the multiplicative algorithm (Silvey, Titterington & Torsney 1978), whose fixed point is the
// optimum. `efficiency`: a lower bound of the optimal variance over that of the result, from the
// equivalence theorem. Errors: InvalidArgument (a sigma or time not above 0); FailedPrecondition
// (the candidates do not determine the activation).
struct LevelDesign {
  std::vector<double> shares;
  double variance_s = 0;  // mean variance times the time in seconds
  double efficiency = 0;  // 0 to 1
};
absl::StatusOr<LevelDesign> OptimalLevels(const ActivationFit& fit, ErrorAtU error,
                                          std::span<const LevelCandidate> candidates,
                                          std::span<const double> u);

// The mean variance times the time that any shares give. Errors: as above.
absl::StatusOr<double> VarianceTimes(const ActivationFit& fit, ErrorAtU error,
                                     std::span<const LevelCandidate> candidates,
                                     std::span<const double> shares, std::span<const double> u);

}  // namespace eyebox::fit

#endif  // EYEBOX_FIT_ACTIVATION_LEVEL_DESIGN_H_
