// A short measurement that tells what longer ones would cost and give on this rig.
#ifndef EYEBOX_SERVICE_PLANNER_PILOT_H_
#define EYEBOX_SERVICE_PLANNER_PILOT_H_

#include <vector>

#include "absl/status/statusor.h"
#include "capture/base/clock.h"
#include "fit/activation/fit_activation.h"
#include "optics/uniformity/smooth_field.h"
#include "service/planner/frame_source.h"
#include "service/planner/setting.h"

namespace eyebox::service {

struct DiskFactor {
  double diameter_deg = 0;
  double factor = 1;  // see Truth::glare_factor
};

struct Pilot {
  ImageSize size;
  PinholeGeometry geometry;
  std::vector<double> exposures_s;
  optics::NoiseModel noise;
  double saturation_dn = 0;     // of a count, bias included
  std::vector<double> dark_dn;  // median count of a dark above noise.bias_dn, [exposures]
  // DN/s of 1 cd/m2, [height, width]; NaN where nothing is known.
  Image<float> response;
  double response_at_reference = 0;
  double flat_luminance = 0;  // unit of the activation
  double flat_relative_sigma = 0;
  size_t reference_pixels = 0;  // of the disk that gives the readings of the levels
  int frames = 0;               // of each exposure of white
  int calibration_frames = 0;
  fit::ActivationFit activation;              // of grey
  std::vector<fit::ActivationFit> primaries;  // of red, green and blue; empty: not measured
  optics::MeasuredImage white;                // unit of the activation
  optics::SmoothField white_smooth;           // of the highest order that the pilot can tell
  std::vector<DiskFactor> disks;              // ascending; empty: not measured
  double compute_s_per_mpx = 0;               // of a frame's pixels, 1e6 at a time
};

// Levels, frames and disks of the pilot.
struct PilotOptions {
  int levels = 9;
  int frames = 4;  // of each exposure
  int calibration_frames = 8;
  std::vector<double> disks_deg = {2, 4, 8, 16, 30};
  int disk_frames = 4;  // of each exposure
  fit::ActivationModel model = fit::ActivationModel::kGammaWithCutoff;
  bool primaries = false;
};

// The usual pilot as far as a source has what it takes; nullptr: it has everything.
PilotOptions PilotWithin(const Stock* limits);

// Errors: those of MeasureSetting.
absl::StatusOr<Pilot> MeasurePilot(FrameSource& source, const Clock& clock,
                                   const PilotOptions& options = {});

// The glare factor of a disk, between those of the pilot; 1 where it measured none.
double GlareFactorOf(const Pilot& pilot, double diameter_deg);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_PLANNER_PILOT_H_
