#include "fit/base/activation.h"

#include <algorithm>
#include <cmath>

#include "fit/base/toe_power.h"

namespace eyebox::fit {
namespace {

// The drive value between cutoff (0) and white (1). Neither end loses digits: v - v0 is exact where
// the two are close, and white gives 1 exactly.
struct Base {
  double x = 0;
  double one_minus_x = 1;
};

Base BaseAt(const Activation& activation, double drive) {
  const double clamped = std::clamp(drive, 0.0, 1.0);
  const double span = 1 - activation.cutoff_drive;
  return {(clamped - activation.cutoff_drive) / span, (1 - std::min(drive, 1.0)) / span};
}

ToePower PowerOf(const Activation& activation) { return {activation.toe_drive, activation.gamma}; }

ToePower::Place Warped(const Activation& activation, const Base& base) {
  return {activation.warp.At(base.x), activation.warp.OneMinusAt(base.one_minus_x)};
}

// dh/dx within (0, 1].
double SlopeByBase(const Activation& activation, const Base& base) {
  return PowerOf(activation).Slope(Warped(activation, base)) * activation.warp.SlopeAt(base.x);
}

}  // namespace

double Activation::H(double drive) const {
  const Base base = BaseAt(*this, drive);
  return base.x <= 0 ? 0 : PowerOf(*this).At(Warped(*this, base));
}

double Activation::InverseH(double activation) const {
  if (activation <= 0) return cutoff_drive;
  if (activation >= 1) return 1;
  const double x = warp.InverseAt(PowerOf(*this).Inverse(activation));
  return cutoff_drive + (1 - cutoff_drive) * x;
}

double Activation::Slope(double drive) const {
  const Base base = BaseAt(*this, drive);
  if (base.x < 0 || drive < 0 || drive > 1) return 0;
  const double slope = SlopeByBase(*this, base) / (1 - cutoff_drive);
  return std::isfinite(slope) ? slope : 0;
}

double Activation::InverseSlope(double activation) const {
  if (activation < 0 || activation > 1) return 0;
  const ToePower power = PowerOf(*this);
  const bool at_an_end = activation == 0 || activation == 1;
  const double y = at_an_end ? activation : power.Inverse(activation);
  const double inverse =
      (1 - cutoff_drive) * power.InverseSlope(activation) / warp.SlopeAt(warp.InverseAt(y));
  return std::isfinite(inverse) ? inverse : 0;
}

std::array<double, 4> Activation::LuminanceGradient(double drive) const {
  const Base base = BaseAt(*this, drive);
  if (base.x <= 0) return {1, 0, 0, 0};
  const ToePower power = PowerOf(*this);
  const ToePower::Place place = Warped(*this, base);
  if (place.y <= 0) return {1, 0, 0, 0};  // the warp of the smallest doubles may be 0
  const double base_by_cutoff = -base.one_minus_x / (1 - cutoff_drive);
  return {1, power.At(place), luminance_range * SlopeByBase(*this, base) * base_by_cutoff,
          luminance_range * power.ByGamma(place)};
}

double Activation::LuminanceByToe(double drive) const {
  const Base base = BaseAt(*this, drive);
  if (base.x <= 0) return 0;
  return luminance_range * PowerOf(*this).ByToe(Warped(*this, base));
}

std::vector<double> Activation::LuminanceByWarp(double drive) const {
  const Base base = BaseAt(*this, drive);
  if (base.x <= 0) return std::vector<double>(warp.Knots().size(), 0.0);
  const ToePower::Place place = Warped(*this, base);
  std::vector<double> derivatives = warp.ByLogSlopes(base.x);
  const double slope = place.y > 0 ? luminance_range * PowerOf(*this).Slope(place) : 0;
  for (double& derivative : derivatives) derivative *= slope;
  return derivatives;
}

}  // namespace eyebox::fit
