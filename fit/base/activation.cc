#include "fit/base/activation.h"

#include <algorithm>
#include <cmath>

namespace eyebox::fit {
namespace {

// The drive value between cutoff (0) and white (1). Neither end loses digits: v - v0 is exact where
// the two are close, and white gives 1 exactly.
double Base(const Activation& activation, double drive) {
  const double clamped = std::clamp(drive, 0.0, 1.0);
  return (clamped - activation.cutoff_drive) / (1 - activation.cutoff_drive);
}

// Near white the rounding of `base` would spoil its logarithm; the distance to white does not.
double LogBase(const Activation& activation, double drive, double base) {
  if (base < 0.5) return std::log(base);
  return std::log1p(-(1 - std::min(drive, 1.0)) / (1 - activation.cutoff_drive));
}

}  // namespace

double Activation::H(double drive) const {
  const double base = Base(*this, drive);
  return base <= 0 ? 0 : std::pow(base, gamma);
}

double Activation::InverseH(double activation) const {
  if (activation <= 0) return cutoff_drive;
  if (activation >= 1) return 1;
  return cutoff_drive + (1 - cutoff_drive) * std::pow(activation, 1 / gamma);
}

std::array<double, 4> Activation::LuminanceGradient(double drive) const {
  const double base = Base(*this, drive);
  if (base <= 0) return {1, 0, 0, 0};
  const double h = std::pow(base, gamma);
  const double base_by_cutoff =
      -(1 - std::min(drive, 1.0)) / ((1 - cutoff_drive) * (1 - cutoff_drive));
  return {1, h, luminance_range * gamma * std::pow(base, gamma - 1) * base_by_cutoff,
          luminance_range * h * LogBase(*this, drive, base)};
}

}  // namespace eyebox::fit
