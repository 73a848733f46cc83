#include "capture/photodiode/sim/strobe_light.h"

#include <algorithm>
#include <cmath>

namespace eyebox::capture {

double StrobeLight::At(double time_s) const {
  const double periods = (time_s - phase_s) / period_s;
  return periods - std::floor(periods) < duty ? 1 : 0;
}

double StrobeLight::IntegralS(double begin_s, double end_s) const {
  const auto since_phase = [this](double time_s) {
    const double periods = (time_s - phase_s) / period_s;
    const double whole = std::floor(periods);
    return (whole * duty + std::min(periods - whole, duty)) * period_s;
  };
  return since_phase(end_s) - since_phase(begin_s);
}

}  // namespace eyebox::capture
