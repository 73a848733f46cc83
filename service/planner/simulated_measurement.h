// A small recording that never touches a disk: what a simulated rig shows to its camera, taken
// through calibration and reduction as a recording is.
#ifndef EYEBOX_SERVICE_PLANNER_SIMULATED_MEASUREMENT_H_
#define EYEBOX_SERVICE_PLANNER_SIMULATED_MEASUREMENT_H_

#include <cstdint>
#include <map>
#include <vector>

#include "capture/camera/sim/noise.h"
#include "capture/camera/sim/parameters.h"
#include "capture/camera/sim/sensor.h"
#include "optics/reduce/reduce_level.h"
#include "service/planner/held_frames.h"

namespace eyebox::service {

struct SimulatedMeasurementOptions {
  std::vector<double> exposures_s = {0.0125, 0.075, 0.45};  // ascending
  int calibration_frames = 8;                               // what Measure() is calibrated with
};

class SimulatedMeasurement final : public HeldFrames {
 public:
  // Another sensor, another true luminance of the flat and other noise for each seed.
  SimulatedMeasurement(const capture::SimParameters& parameters, uint64_t seed,
                       const SimulatedMeasurementOptions& options = {});

  ImageSize Size() const override { return parameters_.sensor.size; }
  int Bits() const override { return parameters_.sensor.bits; }
  const PinholeGeometry& Geometry() const override { return parameters_.geometry; }
  const std::vector<double>& ExposuresS() const override { return options_.exposures_s; }
  absl::StatusOr<Truth> TruthFor(double disk_deg) override;

  // Darks, flats and noise model from calibration_frames, as `eyebox run` learns them.
  absl::Status Calibrate() { return CalibrationOf(options_.calibration_frames).status(); }
  const optics::Calibration& calibration() const {
    return calibrations().at(options_.calibration_frames);
  }
  // Reduced with it.
  absl::StatusOr<optics::ReducedLevel> Measure(const Stimulus& stimulus, int repeats);
  // The flat's luminance as stated over what it was, which scales every luminance.
  double scale_error() const { return 1 / flat_factor_; }
  // What arrives at each pixel, cd/m2, the scatter of the optics included.
  absl::StatusOr<Image<double>> LuminanceOf(const Stimulus& stimulus) const;

 private:
  // The scene of one stimulus, and the frames that were asked for so far.
  struct Shown {
    CaptureSpec spec;
    Image<double> rate_e_s;
    std::vector<std::vector<std::vector<uint16_t>>> frames;  // [exposures][frames]
    std::vector<capture::NoiseSource> noises;                // [exposures]
  };

  absl::StatusOr<std::vector<Counts>> FramesOf(const CaptureSpec& scene, size_t exposure,
                                               int count) override;
  CaptureSpec FlatScene() const override;
  optics::KnownLuminance StatedFlat() const override;
  absl::StatusOr<Shown*> Show(const CaptureSpec& spec);

  capture::SimParameters parameters_;
  uint64_t seed_;
  SimulatedMeasurementOptions options_;
  capture::FixedPattern pattern_;
  double flat_factor_ = 1;
  std::map<std::vector<uint64_t>, Shown> shown_;
};

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_PLANNER_SIMULATED_MEASUREMENT_H_
