// The forward model: what of a stimulus arrives in each pixel, before any noise.
#ifndef EYEBOX_CAPTURE_CAMERA_SIM_SCENE_H_
#define EYEBOX_CAPTURE_CAMERA_SIM_SCENE_H_

#include "absl/status/statusor.h"
#include "capture/base/capture_spec.h"
#include "capture/base/image.h"
#include "capture/camera/sim/parameters.h"
#include "capture/camera/sim/sensor.h"

namespace eyebox::capture {

// Electrons per second of light, [height, width]:
//   light: responsivity * PRNU * cos^4 * (w convolved with (g * stimulus luminance))
//   flat:  responsivity * PRNU * cos^4 * luminance of the spec (no headset, so no g)
//   dark:  0
// A display whose pixel grid is seen (faults) has it multiplied in after the scatter.
// Each factor is one that a step of the reduction removes again.
// Errors: InvalidArgument (names the field of the spec that is missing or out of range).
absl::StatusOr<Image<double>> SceneRate(const SimParameters& parameters,
                                        const FixedPattern& pattern, const CaptureSpec& spec);

}  // namespace eyebox::capture

#endif  // EYEBOX_CAPTURE_CAMERA_SIM_SCENE_H_
