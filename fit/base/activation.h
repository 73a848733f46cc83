// How a place on the display answers to the drive value: L = L0 + L1 h(v).
#ifndef EYEBOX_FIT_BASE_ACTIVATION_H_
#define EYEBOX_FIT_BASE_ACTIVATION_H_

#include <array>
#include <vector>

#include "fit/base/monotone_warp.h"

namespace eyebox::fit {

// h(v) = P(W(x)), x = max((v - v0) / (1 - v0), 0), h(0) = 0, h(1) = 1. W is the warp. P is the
// power y^gamma, or with a toe at b > 0 the form of sRGB: with a = b (gamma - 1), ((y + a) / (1 +
// a))^gamma above b and the straight line through 0 that meets it there with the same slope below.
// The four models: v0 = 0 the power law + offset; v0 > 0 gamma with cutoff; b > 0 sRGB-like; a warp
// the monotone spline on what a gamma fit leaves.
// Valid for 0 <= v0 < 1, gamma > 0, L0 >= 0, L1 > 0, 0 <= b < 1. v outside [0, 1] is clamped.
struct Activation {
  double minimum_luminance = 0;  // L0, cd/m2 (or relative units)
  double luminance_range = 1;    // L1, same unit
  double cutoff_drive = 0;       // v0
  double gamma = 2.2;
  double toe_drive = 0;  // b, in units of x: sRGB has 0.0393 with gamma 2.4
  MonotoneWarp warp{};   // W

  // Relative error below 1e-14 (gamma up to 8), with a warp 1e-13, where v - v0 is above 1e-300 and
  // the result is a normal double. NaN only for a drive that is NaN.
  double H(double drive) const;
  // The drive value at which H is `activation`, in [v0, 1]: v0 for activation <= 0 (the largest
  // drive that still shows L0, so that the inverse is continuous), 1 for activation >= 1. Relative
  // error below 1e-12, with a warp that of an activation which is off by 1e-12 of itself.
  double InverseH(double activation) const;
  // dh/dv: 0 below v0 and above 1. At v0 and at 1 the derivative from within, or 0 at v0 where that
  // is infinite (gamma < 1 without a toe). Relative error below 1e-12.
  double Slope(double drive) const;
  // dv/dh: 0 below 0 and above 1. At 0 and at 1 the derivative from within, or 0 at 0 where that is
  // infinite (gamma > 1 without a toe). Errors as of InverseH.
  double InverseSlope(double activation) const;
  double Luminance(double drive) const { return minimum_luminance + luminance_range * H(drive); }
  // dL/d(L0, L1, v0, gamma) at `drive`, each to 1e-12 relative. At and below v0 it is (1, 0, 0, 0):
  // the limit 0 log 0 = 0 for gamma; for v0 the derivative towards larger v0, which alone exists at
  // drive = v0 for gamma <= 1 (towards smaller v0 it is -L1 (1 - v) / (1 - v0)^2 for gamma = 1 and
  // infinite below). Finite for every finite drive, never NaN.
  std::array<double, 4> LuminanceGradient(double drive) const;
  // dL/db, towards larger b where b = 0. Finite for every finite drive.
  double LuminanceByToe(double drive) const;
  // dL/d(log slope) of each knot of the warp, [knots].
  std::vector<double> LuminanceByWarp(double drive) const;
};

}  // namespace eyebox::fit

#endif  // EYEBOX_FIT_BASE_ACTIVATION_H_
