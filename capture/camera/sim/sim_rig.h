// A simulated headset before a simulated camera.
#ifndef EYEBOX_CAPTURE_CAMERA_SIM_SIM_RIG_H_
#define EYEBOX_CAPTURE_CAMERA_SIM_SIM_RIG_H_

#include "absl/status/statusor.h"
#include "capture/base/clock.h"
#include "capture/camera/rig.h"
#include "capture/camera/sim/parameters.h"

namespace eyebox::capture {

// What config.camera_uri ("sim:NAME" or "sim:NAME?fault=FAULT,...") names; with faults its name
// holds them too. Errors: InvalidArgument (not a known sim: URI).
absl::StatusOr<SimParameters> SimParametersOf(const RigConfig& config);

// The noise of a frame is a function of (seed, ordinal of Present() since opening, ordinal of the
// exposure since that Present()) alone, never of time or of how calls interleave.
// Nothing is presented at first: the camera looks into the dark.
// Errors: InvalidArgument (parameters that do not validate).
absl::StatusOr<Rig> OpenSimRig(const RigConfig& config, const SimParameters& parameters,
                               const Clock* clock);

}  // namespace eyebox::capture

#endif  // EYEBOX_CAPTURE_CAMERA_SIM_SIM_RIG_H_
