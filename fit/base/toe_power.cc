#include "fit/base/toe_power.h"

#include <cmath>

namespace eyebox::fit {

ToePower::ToePower(double toe, double gamma)
    : toe_(toe), gamma_(gamma), shift_(toe * (gamma - 1)), toe_slope_(0) {
  if (toe_ > 0) toe_slope_ = std::pow(toe_ * gamma_ / (1 + shift_), gamma_) / toe_;
}

double ToePower::At(Place place) const {
  if (InToe(place)) return toe_slope_ * place.y;
  return std::pow((place.y + shift_) / (1 + shift_), gamma_);
}

double ToePower::Inverse(double p) const {
  if (p < toe_slope_ * toe_) return p / toe_slope_;
  return (1 + shift_) * std::pow(p, 1 / gamma_) - shift_;
}

double ToePower::InverseSlope(double p) const {
  if (p < toe_slope_ * toe_) return 1 / toe_slope_;
  return (1 + shift_) / gamma_ * std::pow(p, 1 / gamma_ - 1);
}

double ToePower::Slope(Place place) const {
  if (InToe(place)) return toe_slope_;
  return gamma_ * std::pow((place.y + shift_) / (1 + shift_), gamma_ - 1) / (1 + shift_);
}

double ToePower::ByShift(Place place) const {
  const double root = (place.y + shift_) / (1 + shift_);
  const double span = 1 + shift_;
  return gamma_ * std::pow(root, gamma_ - 1) * place.one_minus_y / (span * span);
}

double ToePower::ByGamma(Place place) const {
  if (place.y <= 0) return 0;
  if (InToe(place)) {
    const double root = toe_ * gamma_ / (1 + shift_);
    return toe_slope_ * place.y * (std::log(root) + 1 - root);
  }
  const double root = (place.y + shift_) / (1 + shift_);
  // Near white the rounding of `root` would spoil its logarithm; the distance to white does not.
  const double log_root =
      root < 0.5 ? std::log(root) : std::log1p(-place.one_minus_y / (1 + shift_));
  return std::pow(root, gamma_) * log_root + toe_ * ByShift(place);
}

double ToePower::ByToe(Place place) const {
  if (place.y <= 0) return 0;
  if (InToe(place)) {
    return toe_slope_ * place.y * (gamma_ - 1) * (1 - toe_) / (toe_ * (1 + shift_));
  }
  return (gamma_ - 1) * ByShift(place);
}

}  // namespace eyebox::fit
