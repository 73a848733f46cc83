// One exponent for many locations, each with its own mask and weight:
// L_i(v) = k_i h(v) + delta_i with h(v) = max((v - v0) / (1 - v0), 0)^gamma (Murray, Patel &
// Wiedenmann 2022, fig 7; models.md section 5). For a given (gamma, v0) the model is linear in k
// and delta, so that only gamma, or gamma and v0, are searched for. FitCommonExponent is the faster
// way where all levels of a location are valid together and locations weigh alike.
#ifndef EYEBOX_FIT_FIELD_SHARED_EXPONENT_H_
#define EYEBOX_FIT_FIELD_SHARED_EXPONENT_H_

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "absl/status/statusor.h"

namespace eyebox::fit {

// Borrowed. `luminance` is [levels, locations], level by level; `valid` likewise, or empty: all. A
// location takes part with its valid readings where these are at least 3 at different drives.
struct MaskedStack {
  std::span<const double> drives;  // [levels], each once
  std::span<const float> luminance;
  std::span<const uint8_t> valid;
  size_t LocationCount() const { return drives.empty() ? 0 : luminance.size() / drives.size(); }
};

// The weight of a squared residual is that of its level times that of its location.
struct FieldWeights {
  std::vector<double> levels;     // [levels], above 0
  std::vector<double> locations;  // [locations], 0 leaves a location out
};

// Relative: a location's weight is 1 / (mean of its valid luminances over the mean that their
// levels have in the whole field)^2, a level's 1 / (mean square of its luminances, each over its
// location's share), so that noise of a constant share of the luminance has the same mean weighted
// square at each level. Levels count at least kRelativeFloor of the brightest. Errors:
// InvalidArgument (sizes disagree, a drive or luminance out of range).
absl::StatusOr<FieldWeights> RelativeFieldWeights(const MaskedStack& stack);

struct SharedExponentOptions {
  bool with_cutoff = false;  // search v0 >= 0 too
  double gamma_min = 0.3;
  double gamma_max = 8;
};

struct SharedExponentFit {
  double gamma = 0;
  double cutoff_drive = 0;
  double gamma_sigma = 0;   // from the curvature and the residuals of all locations
  double cutoff_sigma = 0;  // 0 where it was held
  double gamma_cutoff_covariance = 0;
  std::vector<double> gain;    // k, [locations], NaN where a location took no part
  std::vector<double> offset;  // delta, likewise
  std::vector<double> rms;     // weighted rms residual of the location, likewise
  size_t locations = 0;        // that took part
  size_t readings = 0;         // of them
  size_t distinct_masks = 0;
  double degrees_of_freedom = 0;  // readings - 2 locations - 1 (or 2)
  double weighted_sum_of_squares = 0;
  std::string termination;
};

// Memory: locations that share a mask are reduced to at most as many rows as there are levels, with
// the same sums of products. Errors: InvalidArgument (sizes disagree, a drive outside [0, 1] or
// twice, a weight negative or not finite, a valid luminance that is not finite: names level and
// location), FailedPrecondition (no location with 3 valid levels or no degree of freedom left, the
// optimum lies at a limit of gamma, no convergence).
absl::StatusOr<SharedExponentFit> FitSharedExponent(const MaskedStack& stack,
                                                    const FieldWeights& weights,
                                                    const SharedExponentOptions& options = {});

}  // namespace eyebox::fit

#endif  // EYEBOX_FIT_FIELD_SHARED_EXPONENT_H_
