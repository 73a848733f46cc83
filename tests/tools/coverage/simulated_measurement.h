// A small recording that never touches a disk: what a simulated rig shows to its camera, taken
// through calibration and reduction as a recording is.
#ifndef EYEBOX_TESTS_TOOLS_COVERAGE_SIMULATED_MEASUREMENT_H_
#define EYEBOX_TESTS_TOOLS_COVERAGE_SIMULATED_MEASUREMENT_H_

#include <cstdint>
#include <vector>

#include "absl/status/statusor.h"
#include "capture/base/capture_spec.h"
#include "capture/camera/sim/parameters.h"
#include "capture/camera/sim/sensor.h"
#include "optics/reduce/calibration.h"
#include "optics/reduce/reduce_level.h"

namespace eyebox {

// 96 x 96 pixels of 0.1 deg, 12 bits; a tenth of the light goes into a tail of 0.6 deg.
capture::SimParameters SmallRig();

class SimulatedMeasurement {
 public:
  // Another sensor, another true luminance of the flat and other noise for each seed.
  SimulatedMeasurement(const capture::SimParameters& parameters, uint64_t seed);

  // Darks, flats and noise model, as `eyebox run` learns them.
  absl::Status Calibrate();
  const optics::Calibration& calibration() const { return calibration_; }
  // The flat's luminance as stated over what it was, which scales every luminance.
  double scale_error() const { return 1 / flat_factor_; }

  absl::StatusOr<optics::ReducedLevel> Measure(const Stimulus& stimulus, int repeats);
  // What arrives at each pixel, cd/m2, the scatter of the optics included.
  Image<double> Truth(const Stimulus& stimulus) const;

 private:
  absl::StatusOr<std::vector<optics::Stack>> Bracket(const CaptureSpec& spec,
                                                     std::vector<std::vector<uint16_t>>* frames);

  capture::SimParameters parameters_;
  capture::FixedPattern pattern_;
  capture::NoiseSource noise_;
  double flat_factor_ = 1;
  optics::Calibration calibration_;
};

}  // namespace eyebox

#endif  // EYEBOX_TESTS_TOOLS_COVERAGE_SIMULATED_MEASUREMENT_H_
