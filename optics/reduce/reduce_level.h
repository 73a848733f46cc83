// Raw counts of one stimulus to luminance, as the method reads:
// mask saturated and defective pixels, subtract the dark of the same exposure, linearise where the
// calibration holds a curve, divide by the exposure time, merge the bracket by inverse variance,
// divide by the flat, scale to luminance.
//
// The flat comes after the merge because its error is common to all exposures: dividing each of
// them by it would count its variance as independent and average it away.
#ifndef EYEBOX_OPTICS_REDUCE_REDUCE_LEVEL_H_
#define EYEBOX_OPTICS_REDUCE_REDUCE_LEVEL_H_

#include <optional>
#include <span>

#include "absl/status/statusor.h"
#include "optics/photometry/luminance_image.h"
#include "optics/reduce/bracket_report.h"
#include "optics/reduce/calibration.h"
#include "optics/reduce/frame_stacker.h"
#include "optics/reduce/measured_image.h"

namespace eyebox::optics {

struct ReduceOptions {
  // Blooming spoils neighbours: 1 masks the 3 x 3 same-colour neighbours, 0 none.
  int saturation_dilation = 1;
  // How far apart those neighbours are: 0 is colour_period_px. 1 masks the neighbours of every
  // colour: where one colour of a mosaic clips, crosstalk into the others stops growing with it.
  int saturation_step_px = 0;
  double rail_guard_sigmas = 3;  // expected counts this close to a rail are masked
  int smoothing_radius = 2;      // of the expected signal; 2 is 5 x 5 same-colour neighbours
  int colour_period_px = 2;      // distance of same-colour neighbours; 1 for a grey sensor
  double flat_minimum = 0.05;    // of the flat's median; below, the flat is unusable
  // Fills defective pixels of the luminance for display, see RepairDefects(); they stay invalid.
  bool repair_defects = false;
};

// A rate image in DN/s, before flat and scale.
struct ReducedRate {
  MeasuredImage rate;
  BracketReport report;
};

struct ReducedLevel {
  LuminanceImage luminance;
  BracketReport report;
};

// `exposures`: stacks of one stimulus, one per exposure time, in any order, same gain and size.
// Errors: InvalidArgument (none, two of the same exposure, sizes or gains differ, an exposure not
// above 0, no dark of the same exposure and gain, noise model of another gain).
absl::StatusOr<ReducedRate> ReduceRate(std::span<const Stack> exposures,
                                       const Calibration& calibration,
                                       const ReduceOptions& options = {});

// Reduces the frames of a uniform source to the flat that later levels are divided by.
// Errors: those of ReduceRate; FailedPrecondition (no valid pixel, or no light).
absl::StatusOr<FlatField> MeasureFlat(std::span<const Stack> exposures,
                                      const Calibration& calibration,
                                      const std::optional<KnownLuminance>& luminance,
                                      const ReduceOptions& options = {});

// The method. Errors: those of ReduceRate; InvalidArgument (flat of another size).
absl::StatusOr<ReducedLevel> ReduceLevel(std::span<const Stack> exposures,
                                         const Calibration& calibration,
                                         const ReduceOptions& options = {});

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_REDUCE_REDUCE_LEVEL_H_
