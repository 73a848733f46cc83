// Whether the dark frames keep both sides of their noise.
#ifndef EYEBOX_SERVICE_PREFLIGHT_BLACK_LEVEL_H_
#define EYEBOX_SERVICE_PREFLIGHT_BLACK_LEVEL_H_

#include <cstdint>
#include <span>

#include "service/preflight/check.h"

namespace eyebox::service {

struct BlackLevelOptions {
  double largest_share_at_zero = 1e-3;  // of the pixels; dead ones are at 0 too
  double largest_skewness = 0.3;        // beside 3 sigma; half a Gaussian has 1
  // Noise below this, DN rms, is mostly rounding and has no shape: its skewness is not looked at.
  double least_noise_dn = 0.6;
};

// Counts of one or more dark frames of one exposure, in any order.
// Figures: share_at_zero (decides), skewness, noise, median.
Check CheckBlackLevel(std::span<const uint16_t> counts_dn, int significant_bits,
                      const BlackLevelOptions& options = {});

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_PREFLIGHT_BLACK_LEVEL_H_
