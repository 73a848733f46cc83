// One exponent for the whole field: L_i(v) = k_i v^gamma + delta_i over N locations and M levels
// (Murray, Patel & Wiedenmann 2022, fig 7). For a given gamma the model is linear, so that the sum
// of squares over all locations is tr(S) - tr(P_gamma S) with S = Y^T Y (M x M): one pass over the
// data, a one-dimensional search on an M x M matrix, one pass for k and delta.
#ifndef EYEBOX_FIT_FIELD_COMMON_EXPONENT_H_
#define EYEBOX_FIT_FIELD_COMMON_EXPONENT_H_

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "capture/base/large_memory.h"

namespace eyebox::fit {

// Borrowed. `luminance` is [levels, locations], level by level; `drives` are the levels' drive
// values, each once. A location takes part where `valid` (size locations, or empty: all) is not 0;
// its luminances must then be finite.
struct FieldStack {
  std::span<const double> drives;
  std::span<const float> luminance;
  std::span<const uint8_t> valid;
  size_t LocationCount() const { return drives.empty() ? 0 : luminance.size() / drives.size(); }
};

// What keeping the luminances of a stack in single precision costs at most, of a fitted luminance,
// over displays of any gamma, black and brightness (numerics table).
inline constexpr double kSinglePrecisionLoss = 1e-6;

struct CommonExponentOptions {
  // Weight of each level's squared residual, above 0, [levels]; empty: 1 / (mean luminance)^2, so
  // that errors count relatively; the mean of at least kRelativeFloor of the brightest level's.
  std::vector<double> level_weights;
  double gamma_min = 0.3;
  double gamma_max = 8;
};

struct CommonExponentFit {
  double gamma = 0;
  double gamma_sigma = 0;           // from the curvature and the residuals of all locations
  UninitialisedVector<float> gain;  // k, [locations], NaN where not valid
  // From the location's own residuals, whose noise may be another than its neighbours', and gamma's
  // share.
  UninitialisedVector<float> gain_sigma;
  UninitialisedVector<float> offset;  // delta, likewise
  UninitialisedVector<float> offset_sigma;
  size_t locations = 0;           // that took part
  double degrees_of_freedom = 0;  // locations (levels - 2) - 1
  double weighted_sum_of_squares = 0;
  double rms_relative = 0;  // of residual / mean luminance of the level (at least the floor)
  std::string termination;  // why the search stopped, in words
};

// Errors: InvalidArgument (sizes disagree, a drive outside [0, 1] or twice, a weight not above 0, a
// valid luminance that is not finite: names level and location), FailedPrecondition (fewer than 4
// levels, no valid location, the optimum lies at a limit of gamma, the mean luminance does not rise
// with the drive).
absl::StatusOr<CommonExponentFit> FitCommonExponent(const FieldStack& stack,
                                                    const CommonExponentOptions& options = {});

}  // namespace eyebox::fit

#endif  // EYEBOX_FIT_FIELD_COMMON_EXPONENT_H_
