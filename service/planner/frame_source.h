// Where the frames of a setting come from: a simulated rig, which knows the truth, or a recording,
// part of which is taken for it.
#ifndef EYEBOX_SERVICE_PLANNER_FRAME_SOURCE_H_
#define EYEBOX_SERVICE_PLANNER_FRAME_SOURCE_H_

#include <functional>
#include <vector>

#include "absl/status/statusor.h"
#include "capture/base/capture_spec.h"
#include "capture/base/geometry.h"
#include "capture/base/image.h"
#include "optics/reduce/calibration.h"
#include "optics/reduce/frame_stacker.h"

namespace eyebox::service {

// What a measurement is compared with.
struct Truth {
  Image<double> white;  // cd/m2 of the white full field, [height, width]; NaN: not known
  std::function<double(const DriveRgb&)> relative_luminance;  // at the reference point, 1 at white
  double glare_factor = 1;      // luminance amid a white disk on black over that of the white field
  double stated_over_true = 1;  // of the luminance scale, common to everything measured
  double white_relative_variance = 0;  // of its own noise, mean over places
};

// What a source can give that cannot give everything.
struct Stock {
  std::vector<double> drives;     // of grey full fields, ascending
  int frames = 0;                 // of each of them, in each exposure
  int calibration_frames = 0;     // of darks and of flats, in each exposure
  std::vector<double> disks_deg;  // white on black, ascending
  int disk_frames = 0;            // of each of them, in each exposure
};

class FrameSource {
 public:
  virtual ~FrameSource() = default;

  virtual ImageSize Size() const = 0;
  virtual int Bits() const = 0;
  virtual const PinholeGeometry& Geometry() const = 0;
  virtual const std::vector<double>& ExposuresS() const = 0;  // ascending
  // Learnt from so many darks and flats of each exposure. Valid while the source lives.
  virtual absl::StatusOr<const optics::Calibration*> CalibrationOf(int frames) = 0;
  // Stacks of `frames` [exposures] frames; no stack where that is 0. The same frames for the same
  // question, and the first ones where fewer are asked for.
  virtual absl::StatusOr<std::vector<optics::Stack>> Take(const Stimulus& stimulus,
                                                          const std::vector<int>& frames) = 0;
  virtual const Stock* Limits() const { return nullptr; }  // none: it gives whatever is asked for
  // `disk_deg`: diameter of the disk of glare_factor; 0: none.
  virtual absl::StatusOr<Truth> TruthFor(double disk_deg) = 0;
};

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_PLANNER_FRAME_SOURCE_H_
