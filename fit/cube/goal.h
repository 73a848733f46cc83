// What a table is to achieve: luminance proportional to the rendered value (HDRP model, eq 15).
// Here x = u / r is the rendered value as a fraction of white, r the value that white stands for.
// Relative errors below 1e-15 of a luminance and 1e-12 of a drive value without a warp.
#ifndef EYEBOX_FIT_CUBE_GOAL_H_
#define EYEBOX_FIT_CUBE_GOAL_H_

#include "fit/base/activation.h"

namespace eyebox::fit {

// (L0 + L1) x, but never below the display's minimum L0; unit of L0.
double WantedLuminance(const Activation& activation, double x);

// Luminance at `drive` / WantedLuminance - 1.
double RelativeError(const Activation& activation, double drive, double x);

// The drive value in [v0, infinity) that shows `luminance`: h^-1 continued beyond white, where the
// display cannot follow but the entry above white must point. v0 at and below L0.
double DriveForLuminance(const Activation& activation, double luminance);

// x below which the display's minimum is shown: w / (1 + w), w = L0 / L1.
double CutoffOf(const Activation& activation);

}  // namespace eyebox::fit

#endif  // EYEBOX_FIT_CUBE_GOAL_H_
