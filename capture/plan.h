// Which captures a measurement consists of.
#ifndef EYEBOX_CAPTURE_PLAN_H_
#define EYEBOX_CAPTURE_PLAN_H_

#include <cstdint>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "capture/base/capture_spec.h"

namespace eyebox::capture {

inline constexpr const char* kReferenceSeries = "reference";
inline constexpr const char* kGlareSeries = "glare";

// Defaults fit "sim:rift-s-like" and displays like it (peak 59 cd/m2, black 0.19 cd/m2).
struct PlanOptions {
  int levels = 17;  // drive values i / (levels - 1)
  // The bracket. Factors of 6 overlap by far more than the rails take away. White fills about 75 %
  // of the well in the shortest; black is 1700 e- in the longest, 600 times the read noise. All
  // are whole numbers of 80 Hz refresh periods, so that a strobed panel shows no beat.
  std::vector<double> exposures_s = {0.0125, 0.075, 0.45};
  double gain_db = 0;
  int repeats = 2;  // frames per level and exposure
  int dark_repeats = 8;
  // The darks come back after every so many levels and after the last: for a camera whose
  // temperature changes. 0: they are taken once, at the beginning.
  int dark_every = 0;
  // Flats fill about 70 % of the well in the middle exposure and still count in the shortest:
  // 8 frames of each leave 0.29 % per pixel on the axis, 0.34 % in the corners (cos^4 = 0.69).
  int flat_repeats = 8;  // 0: no flats
  double flat_luminance_cd_m2 = 9;
  double flat_luminance_relative_sigma = 0.02;  // of the photometer that read the reference
  uint64_t seed = 1;                            // of the order of levels
  // A grey patch comes back before the first level, after every so many and after the last, and
  // after disks and checkerboards, in the shortest exposure, which nothing saturates. It shows
  // drift and whether the headset slept.
  int reference_every = 0;  // levels; 0: no reference
  double reference_drive = 0.5;
  int reference_repeats = 4;
  // Disks that show how light scatters: bright on drive 0, black on bright. Any of them, and any
  // checkerboard, brings the black and the bright full field too, after the levels, as the series
  // kGlareSeries.
  std::vector<double> disk_diameters_deg = {};
  std::vector<double> black_disk_diameters_deg = {};
  // Sides of the squares of checkerboards, in the same series.
  std::vector<double> checkerboard_squares_deg = {};
  double disk_drive = 1;  // of whatever is bright in that series
  int disk_repeats = 4;

  // Errors: InvalidArgument (names the field and what it may be).
  absl::Status Validate() const;
};

// Darks of every exposure (with dark_every between the levels too), flats at every exposure
// (reduction masks what saturates), then grey full fields: the levels in random order, so that
// drift of display or camera does not look like a slope, each with the whole bracket, shortest
// exposure first. Level i has level_id i. References between them are the series kReferenceSeries;
// disks follow, as given. Errors: those of Validate().
absl::StatusOr<CapturePlan> MakeGreyPlan(const PlanOptions& options);

// 0 to levels - 1 in the order of such a plan (Fisher & Yates).
std::vector<int> ShuffledLevels(int levels, uint64_t seed);

}  // namespace eyebox::capture

#endif  // EYEBOX_CAPTURE_PLAN_H_
