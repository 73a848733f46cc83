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

  double H(double drive) const;
  // The drive value at which H is `activation`, in [v0, 1]: v0 for activation <= 0 (the largest
  // drive that still shows L0, so that the inverse is continuous), 1 for activation >= 1.
  double InverseH(double activation) const;
  double Luminance(double drive) const { return minimum_luminance + luminance_range * H(drive); }
  // dL/d(L0, L1, v0, gamma) at `drive`; exact at drive = 0 and drive = v0, never NaN.
  std::array<double, 4> LuminanceGradient(double drive) const;
};

}  // namespace eyebox::fit

#endif  // EYEBOX_FIT_BASE_ACTIVATION_H_
