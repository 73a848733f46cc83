// The camera's optics: what a pinhole or a lens does to the light on its way to the sensor.
#ifndef EYEBOX_CAPTURE_CAMERA_SIM_OPTICS_H_
#define EYEBOX_CAPTURE_CAMERA_SIM_OPTICS_H_

#include "absl/status/statusor.h"
#include "capture/base/geometry.h"
#include "capture/base/image.h"
#include "capture/camera/sim/parameters.h"

namespace eyebox::capture {

// w(x), odd-sized square, its centre in the middle, sum 1 (Murray, Patel & Wiedenmann 2022, eq 4).
Image<double> ScatterKernel(const ScatterParameters& parameters);

// scene * w, [height, width]. What lies outside the image is taken to go on as at its border, so
// that a uniform field stays itself. Returns the scene untouched where scatter is switched off.
// Errors: Internal (the Fourier transform failed).
absl::StatusOr<Image<double>> Scatter(const Image<double>& scene,
                                      const ScatterParameters& parameters);

// cos^4 of the field angle, [height, width], 1 on the axis: a pinhole's natural vignetting.
Image<double> Vignetting(const PinholeGeometry& geometry, ImageSize size);

}  // namespace eyebox::capture

#endif  // EYEBOX_CAPTURE_CAMERA_SIM_OPTICS_H_
