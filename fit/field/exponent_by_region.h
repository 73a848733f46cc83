// Whether one exponent serves the whole field, or each region needs its own.
#ifndef EYEBOX_FIT_FIELD_EXPONENT_BY_REGION_H_
#define EYEBOX_FIT_FIELD_EXPONENT_BY_REGION_H_

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "fit/field/shared_exponent.h"

namespace eyebox::fit {

struct RegionExponent {
  int region = 0;
  SharedExponentFit fit;  // k, delta and rms are [locations of the region], in their order
};

struct RegionComparison {
  SharedExponentFit common;
  std::vector<RegionExponent> regions;
  double f = 0;  // (saved squares / numerator freedom) / (squares left / denominator freedom)
  double numerator_freedom = 0;    // parameters of the shape times (regions - 1)
  double denominator_freedom = 0;  // of the fits by region together
  double p_value = 1;              // of an F as large if one exponent were true
  // BIC of an exponent a region less that of one exponent; above 0 speaks for one exponent.
  double delta_bic = 0;
  // Unless the F test at kSignificance and delta-BIC both speak against it: with many locations the
  // first alone finds differences that are not worth an exponent.
  bool one_serves = true;
  std::string reason;
};

constexpr double kSignificance = 0.05;

// `region_of` [locations]: the region of each location, below 0 where it belongs to none and is
// left out of both hypotheses. Both are fitted with the same weights. The F test keeps its size
// where the variance of a reading is inversely proportional to its weight on average over each
// level, and readings are independent: bin pixels that share an optical spot first. Errors: those
// of FitSharedExponent, naming the region; FailedPrecondition (fewer than 2 regions).
absl::StatusOr<RegionComparison> CompareRegions(const MaskedStack& stack,
                                                const FieldWeights& weights,
                                                std::span<const int> region_of,
                                                const SharedExponentOptions& options = {});

}  // namespace eyebox::fit

#endif  // EYEBOX_FIT_FIELD_EXPONENT_BY_REGION_H_
