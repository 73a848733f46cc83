// Whether an exposure collects the same light wherever in the strobe it begins.
#ifndef EYEBOX_CAPTURE_PHOTODIODE_EXPOSURE_CHECK_H_
#define EYEBOX_CAPTURE_PHOTODIODE_EXPOSURE_CHECK_H_

#include "absl/status/statusor.h"
#include "capture/photodiode/strobe.h"

namespace eyebox::capture {

struct ExposureCheck {
  double periods = 0;  // n = exposure / period
  double periods_sigma = 0;
  bool whole = false;  // worst_relative is within the tolerance
  // Largest relative error of the light of one exposure, over every phase at which it may begin, n
  // within 2 sigma, and the duty that was measured.
  double worst_relative = 0;
  // The same for any duty: 1 / n, or 0 where `whole`.
  double bound_relative = 0;
  double nearest_whole_s = 0;  // the whole number of periods that is nearest, 1 at least
};

// Of a steady display every exposure is whole. `tolerance` is relative, above 0.
// Errors: InvalidArgument (exposure or tolerance not finite and above 0).
absl::StatusOr<ExposureCheck> CheckExposure(double exposure_s, const StrobeMeasurement& strobe,
                                            double tolerance = 0.002);

}  // namespace eyebox::capture

#endif  // EYEBOX_CAPTURE_PHOTODIODE_EXPOSURE_CHECK_H_
