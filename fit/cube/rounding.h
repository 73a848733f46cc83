// Entries that a file holds in 8 bits: which way to round each is part of the design.
#ifndef EYEBOX_FIT_CUBE_ROUNDING_H_
#define EYEBOX_FIT_CUBE_ROUNDING_H_

#include <vector>

#include "fit/base/activation.h"
#include "fit/cube/minimax.h"

namespace eyebox::fit {

// Drive values k / 255, monotone, near `entries` [size] in [0, 1]: of all combinations of levels
// within 16 of each (the one that reaches below the range: of all levels), the one whose worst
// relative error over `points` is smallest, and among those the one with the smallest rms. Entries
// outside the range are rounded to the nearest. Dynamic programming over neighbouring entries.
std::vector<double> RoundTo8Bits(const Activation& activation, const std::vector<double>& entries,
                                 const std::vector<DesignPoint>& points);

}  // namespace eyebox::fit

#endif  // EYEBOX_FIT_CUBE_ROUNDING_H_
