// Entries that a file holds in 8 bits: which way to round each is part of the design.
#ifndef EYEBOX_FIT_CUBE_ROUNDING_H_
#define EYEBOX_FIT_CUBE_ROUNDING_H_

#include <vector>

#include "fit/base/activation.h"
#include "fit/cube/minimax.h"

namespace eyebox::fit {

// Drive values k / 255, monotone, near `entries` [size]: among all combinations of the whole
// numbers around each, the one whose worst relative error over `points` is smallest, and among
// those the one with the smallest rms. Dynamic programming over neighbouring entries.
std::vector<double> RoundTo8Bits(const Activation& activation, const std::vector<double>& entries,
                                 const std::vector<DesignPoint>& points);

}  // namespace eyebox::fit

#endif  // EYEBOX_FIT_CUBE_ROUNDING_H_
