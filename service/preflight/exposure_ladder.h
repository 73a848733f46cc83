// Whether the signal follows the exposure: log signal against log exposure has slope 1.
#ifndef EYEBOX_SERVICE_PREFLIGHT_EXPOSURE_LADDER_H_
#define EYEBOX_SERVICE_PREFLIGHT_EXPOSURE_LADDER_H_

#include <span>

#include "service/preflight/check.h"

namespace eyebox::service {

struct LadderRung {
  double exposure_s = 0;
  double signal_dn = 0;  // light minus dark, mean over the field
  double sigma_dn = 0;   // its standard uncertainty, from frame to frame and from pixel noise
  bool saturated = false;
  double pixel_sigma_dn = 0;  // what the noise of the pixels alone would leave
};

struct LadderOptions {
  int least_rungs = 5;         // that have signal and are not saturated
  double least_decades = 1.5;  // that they span
  // Allowed beside 3 sigma: what the camera's own clock and linearity may leave.
  double slope_tolerance = 0.002;
  double largest_slope_sigma = 0.01;  // less is no proof
  double largest_residual = 0.02;     // relative, of any rung
  double rung_floor = 5e-4;  // relative uncertainty of a rung that no number of pixels improves
};

// Fails also where slope 1 could not be proven: too few rungs, too little light, light that is not
// steady. Figures: slope, residual_rms, rungs, decades.
Check CheckExposureLadder(std::span<const LadderRung> rungs, const LadderOptions& options = {});

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_PREFLIGHT_EXPOSURE_LADDER_H_
