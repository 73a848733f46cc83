// How a place on the display answers to the drive value: L = L0 + L1 h(v).
#ifndef EYEBOX_FIT_BASE_ACTIVATION_H_
#define EYEBOX_FIT_BASE_ACTIVATION_H_

#include <array>

namespace eyebox::fit {

// h(v) = max((v - v0) / (1 - v0), 0)^gamma, h(0) = 0, h(1) = 1; v0 = 0 is the power law + offset.
// Valid for 0 <= v0 < 1, gamma > 0, L0 >= 0, L1 > 0. v outside [0, 1] is clamped.
struct Activation {
  double minimum_luminance = 0;  // L0, cd/m2 (or relative units)
  double luminance_range = 1;    // L1, same unit
  double cutoff_drive = 0;       // v0
  double gamma = 2.2;

  // Relative error below 1e-14 (gamma up to 8). NaN only for a drive that is NaN.
  double H(double drive) const;
  // The drive value at which H is `activation`, in [v0, 1]: v0 for activation <= 0 (the largest
  // drive that still shows L0, so that the inverse is continuous), 1 for activation >= 1. Relative
  // error below 1e-12.
  double InverseH(double activation) const;
  double Luminance(double drive) const { return minimum_luminance + luminance_range * H(drive); }
  // dL/d(L0, L1, v0, gamma) at `drive`, each to 1e-12 relative. At and below v0 it is (1, 0, 0, 0):
  // the limit 0 log 0 = 0 for gamma; for v0 the derivative towards larger v0, which alone exists at
  // drive = v0 for gamma <= 1 (towards smaller v0 it is -L1 (1 - v) / (1 - v0)^2 for gamma = 1 and
  // infinite below). Finite for every finite drive, never NaN.
  std::array<double, 4> LuminanceGradient(double drive) const;
};

}  // namespace eyebox::fit

#endif  // EYEBOX_FIT_BASE_ACTIVATION_H_
