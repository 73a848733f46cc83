// The stages of the forward model that are no part of a sound rig.
#ifndef EYEBOX_CAPTURE_CAMERA_SIM_FAULTS_H_
#define EYEBOX_CAPTURE_CAMERA_SIM_FAULTS_H_

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "absl/status/statusor.h"
#include "capture/base/image.h"
#include "capture/camera/camera.h"
#include "capture/camera/sim/parameters.h"

namespace eyebox::capture {

// "fault=NAME" or "fault=NAME,NAME", as in sim:rift-s-like?fault=gamma. The strobe is that of the
// photodiode sim:strobe-90hz; a rolling shutter comes with it, since without it none is seen.
// Errors: InvalidArgument (anything else: lists the known names).
absl::StatusOr<SimFaults> ParseFaults(std::string_view query);
std::vector<std::string> SimFaultNames();

// Which exposure the sensor makes, whatever it was told.
class ExposureFault {
 public:
  ExposureFault(const SimFaults& faults, const SensorParameters& sensor)
      : faults_(faults), sensor_(sensor) {}

  // Seconds. To be called once an exposure, in order.
  double Made(const CameraSettings& settings, const Image<double>& photo_rate_e_s);

 private:
  double Automatic(const CameraSettings& settings, const Image<double>& photo_rate_e_s) const;

  const SimFaults faults_;
  const SensorParameters sensor_;
  std::optional<double> told_s_;
  double old_s_ = 0;
  int stale_left_ = 0;
};

// The rate of a display that flashes, averaged over an exposure of each row that begins begin_s
// after the start of a flash (row 0; the others later if the shutter rolls). The mean over time is
// that of the steady display.
Image<double> Flashed(const SimFaults& faults, const Image<double>& rate, double begin_s,
                      double exposure_s);

// Of the sensor while a presentation stands; none where it does not warm up.
std::optional<double> SensorTemperatureDegC(const SimFaults& faults, uint64_t presentation);

// Dark current at this temperature over that of a sensor just switched on.
double DarkCurrentGrowth(std::optional<double> temperature_deg_c);

// The pixel grid of the display as the pixels of the camera integrate it, mean 1.
Image<double> DisplayGrid(const SimFaults& faults, ImageSize size);

// What the camera does to its counts before it sends them: black level and gamma.
void Distort(const SimFaults& faults, const SensorParameters& sensor,
             std::vector<uint16_t>& counts_dn);

}  // namespace eyebox::capture

#endif  // EYEBOX_CAPTURE_CAMERA_SIM_FAULTS_H_
