// Whether the first frames after a change of exposure are already of the new one.
#ifndef EYEBOX_SERVICE_PREFLIGHT_STALE_FRAMES_H_
#define EYEBOX_SERVICE_PREFLIGHT_STALE_FRAMES_H_

#include <span>
#include <vector>

#include "service/preflight/check.h"

namespace eyebox::service {

// One change of exposure. Frame means in DN, over the same pixels.
struct ExposureChange {
  double old_exposure_s = 0;
  double new_exposure_s = 0;
  std::vector<double> old_means_dn = {};    // settled at the old exposure
  std::vector<double> first_means_dn = {};  // k = 0, 1, ... after the change
  std::vector<double> new_means_dn = {};    // settled at the new exposure
};

struct StaleOptions {
  double tolerance = 0.02;  // of the step: so much of the old exposure may show in a frame
};

// A frame is stale as far as any frame from k = 0 to it does not lie at the new level. The figure
// that decides is the largest number of such frames over all changes.
// Skipped where two exposures give the same light: then the exposure ladder says why.
Check CheckStaleFrames(std::span<const ExposureChange> changes, const StaleOptions& options = {});

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_PREFLIGHT_STALE_FRAMES_H_
