// Proves by light that a rig measures light: everything automatic is off, the counts follow the
// exposure, and neither refresh, shutter nor pixel grid spoils them.
#ifndef EYEBOX_SERVICE_PREFLIGHT_PREFLIGHT_H_
#define EYEBOX_SERVICE_PREFLIGHT_PREFLIGHT_H_

#include <optional>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "capture/camera/rig.h"
#include "capture/photodiode/photodiode.h"
#include "service/preflight/check.h"
#include "service/watcher.h"

namespace eyebox::service {

struct PreflightOptions {
  // That will be used to measure; each must be a whole number of refresh periods.
  std::vector<double> exposures_s = {};
  std::optional<double> camera_px_per_display_px = {};
  int frames = 3;         // of each setting, 2 at least
  int settle_frames = 5;  // dropped after every change; as many are searched for stale ones
  double longest_ladder_s = 1;

  // Errors: InvalidArgument (names the field).
  absl::Status Validate() const;
};

// In the order in which they are listed: read_back, exposure_ladder, stale_frames, black_level,
// refresh, whole_periods, rolling_shutter, moire. `photodiode` may be null.
// The rig shows grey full fields first and the dark last. The camera is stopped when this returns.
// A check that fails is no error. Errors: those of camera and presenter, Cancelled, InvalidArgument
// (options; an exposure outside the camera's limits).
absl::StatusOr<std::vector<Check>> RunPreflight(capture::Rig& rig, capture::Photodiode* photodiode,
                                                const PreflightOptions& options,
                                                const Watcher& watcher);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_PREFLIGHT_PREFLIGHT_H_
