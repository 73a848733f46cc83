// Whether the camera says that it is set as it was told.
#ifndef EYEBOX_SERVICE_PREFLIGHT_READ_BACK_H_
#define EYEBOX_SERVICE_PREFLIGHT_READ_BACK_H_

#include <span>

#include "capture/camera/camera.h"
#include "service/preflight/check.h"

namespace eyebox::service {

struct ReadBack {
  capture::CameraSettings asked;
  capture::CameraSettings reported;  // by the camera, or by one of its frames
};

struct ReadBackOptions {
  double exposure_tolerance = 1e-4;  // relative, as a run allows
  double gain_tolerance_db = 1e-3;
};

// The figure that decides is the number of settings, of all read-backs, that differ. Figures:
// settings, largest_exposure_deviation. Fails where nothing was read back.
Check CheckReadBack(std::span<const ReadBack> read_backs, const ReadBackOptions& options = {});

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_PREFLIGHT_READ_BACK_H_
