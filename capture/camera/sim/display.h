// The headset: how it answers to the drive value, and how that varies over its field.
#ifndef EYEBOX_CAPTURE_CAMERA_SIM_DISPLAY_H_
#define EYEBOX_CAPTURE_CAMERA_SIM_DISPLAY_H_

#include "absl/status/statusor.h"
#include "capture/base/capture_spec.h"
#include "capture/base/image.h"
#include "capture/camera/sim/parameters.h"

namespace eyebox::capture {

// h(v) = max((v - v0) / (1 - v0), 0)^gamma: "gamma with cutoff", h(0) = 0 and h(1) = 1.
double Activation(const ChannelParameters& channel, double drive);

// L = L0 + L1 sum_k weight_k h_k(v_k), cd/m2, at the reference point.
double DisplayLuminance(const DisplayParameters& display, const DriveRgb& drive);

// g(x), [height, width], 1 at the image centre ((width - 1) / 2, (height - 1) / 2).
Image<double> Nonuniformity(const NonuniformityParameters& parameters, ImageSize size);

// The stimulus on a perfectly uniform display, cd/m2, [height, width].
// Errors: InvalidArgument (no drive value, a drive outside [0, 1], a disk without diameter).
absl::StatusOr<Image<double>> DrawStimulus(const DisplayParameters& display,
                                           const PinholeGeometry& geometry, ImageSize size,
                                           const Stimulus& stimulus);

}  // namespace eyebox::capture

#endif  // EYEBOX_CAPTURE_CAMERA_SIM_DISPLAY_H_
