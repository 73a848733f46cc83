#include "fit/cube/goal.h"

#include <algorithm>
#include <cmath>

namespace eyebox::fit {
namespace {

double White(const Activation& activation) {
  return activation.minimum_luminance + activation.luminance_range;
}

}  // namespace

double WantedLuminance(const Activation& activation, double x) {
  return std::max(White(activation) * x, activation.minimum_luminance);
}

double RelativeError(const Activation& activation, double drive, double x) {
  return activation.Luminance(drive) / WantedLuminance(activation, x) - 1;
}

double DriveForLuminance(const Activation& activation, double luminance) {
  const double h = (luminance - activation.minimum_luminance) / activation.luminance_range;
  if (h <= 1) return activation.InverseH(h);
  const double cutoff = activation.cutoff_drive;
  return cutoff + (1 - cutoff) * std::pow(h, 1 / activation.gamma);
}

double CutoffOf(const Activation& activation) {
  return activation.minimum_luminance / White(activation);
}

}  // namespace eyebox::fit
