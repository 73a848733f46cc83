#include "capture/photodiode/exposure_check.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "capture/base/status.h"

namespace eyebox::capture {
namespace {

// Light of n periods lies between that of the best and the worst beginning: floor(n) flashes and
// what the rest r of a period can catch of one, at most min(r, d), at least max(0, r + d - 1).
double WorstRelative(double periods, double duty) {
  const double rest = periods - std::floor(periods);
  const double most = std::min(rest, duty) - rest * duty;
  const double least = rest * duty - std::max(0.0, rest + duty - 1);
  return std::max(most, least) / (periods * duty);
}

// The error has one maximum between two whole numbers, at r = d or r = 1 - d at the latest.
double WorstWithin(double low, double high, double duty) {
  double worst = std::max(WorstRelative(low, duty), WorstRelative(high, duty));
  for (const double rest : {duty, 1 - duty}) {
    const double candidate = std::ceil(low - rest) + rest;
    if (candidate > low && candidate < high)
      worst = std::max(worst, WorstRelative(candidate, duty));
  }
  return worst;
}

}  // namespace

absl::StatusOr<ExposureCheck> CheckExposure(double exposure_s, const StrobeMeasurement& strobe,
                                            double tolerance) {
  if (!std::isfinite(exposure_s) || exposure_s <= 0) {
    return BadInput("exposure_s", "is " + std::to_string(exposure_s), "give seconds above 0");
  }
  if (!std::isfinite(tolerance) || tolerance <= 0) {
    return BadInput("tolerance", "is " + std::to_string(tolerance), "give a share like 0.002");
  }
  ExposureCheck check = {.whole = true, .nearest_whole_s = exposure_s};
  if (!strobe.strobed) return check;
  check.periods = exposure_s / strobe.period_s;
  check.periods_sigma = check.periods * strobe.period_sigma_s / strobe.period_s;
  check.nearest_whole_s = std::max(std::round(check.periods), 1.0) * strobe.period_s;
  const double margin = std::min(2 * check.periods_sigma, check.periods / 2);
  const double duty = std::clamp(strobe.duty, 1e-6, 1.0);
  check.worst_relative = WorstWithin(check.periods - margin, check.periods + margin, duty);
  check.whole = check.worst_relative <= tolerance;
  check.bound_relative = check.whole ? 0 : 1 / check.periods;
  return check;
}

}  // namespace eyebox::capture
