// How the display flashes, as the photodiode sees it, and whether the exposures fit.
#ifndef EYEBOX_SERVICE_PREFLIGHT_REFRESH_H_
#define EYEBOX_SERVICE_PREFLIGHT_REFRESH_H_

#include <optional>
#include <span>

#include "absl/status/statusor.h"
#include "capture/photodiode/photodiode.h"
#include "capture/photodiode/strobe.h"
#include "service/preflight/check.h"

namespace eyebox::service {

struct RefreshOptions {
  double largest_period_sigma = 1e-3;  // relative
  double record_s = 2;                 // each of two records
  double sample_rate_hz = 4000;        // of the first, or what the photodiode can do
};

// Two records at rates without a small common multiple, so that no alias passes for a period.
// Errors: those of Photodiode and MeasureStrobe(); FailedPrecondition (an alias).
absl::StatusOr<capture::StrobeMeasurement> MeasureRefresh(capture::Photodiode& photodiode,
                                                          const RefreshOptions& options = {});

// `strobe` is empty where there is no photodiode: then the check is skipped.
// Figures: period (decides), duty, depth.
Check CheckRefresh(const std::optional<absl::StatusOr<capture::StrobeMeasurement>>& strobe,
                   const RefreshOptions& options = {});

// Fails if any exposure is no whole number of periods, within `tolerance` of its light. The figure
// that decides is the largest relative error of one exposure; further ones are, for each exposure,
// its periods and, unless whole, the bound 1 / n.
Check CheckWholePeriods(const std::optional<absl::StatusOr<capture::StrobeMeasurement>>& strobe,
                        std::span<const double> exposures_s, double tolerance = 0.002);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_PREFLIGHT_REFRESH_H_
