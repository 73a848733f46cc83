// The sensor: light to electrons to counts, EMVA 1288 release 4.0, linear model.
#ifndef EYEBOX_CAPTURE_CAMERA_SIM_SENSOR_H_
#define EYEBOX_CAPTURE_CAMERA_SIM_SENSOR_H_

#include <cstdint>
#include <vector>

#include "capture/base/image.h"
#include "capture/camera/camera.h"
#include "capture/camera/sim/noise.h"
#include "capture/camera/sim/parameters.h"

namespace eyebox::capture {

// What is the same in every frame of one sensor. Maps are [height, width].
struct FixedPattern {
  Image<double> response;          // relative, mean 1 (PRNU)
  Image<double> dark_current_e_s;  // with hot pixels
  Image<double> offset_e;          // DSNU at zero exposure
};

// The sensor with this seed.
FixedPattern MakeFixedPattern(const SensorParameters& sensor, uint64_t seed);

// One frame, DN, row by row. `photo_rate_e_s` is [height, width], as SceneRate() gives it.
// Light and dark current are Poisson, what exceeds the full well is lost, read noise is Gaussian,
// counts are rounded and clipped to 0 .. 2^bits - 1.
std::vector<uint16_t> Expose(const SensorParameters& sensor, const FixedPattern& pattern,
                             const Image<double>& photo_rate_e_s, const CameraSettings& settings,
                             NoiseSource& noise);

}  // namespace eyebox::capture

#endif  // EYEBOX_CAPTURE_CAMERA_SIM_SENSOR_H_
