#include "optics/render/log_c.h"

#include <algorithm>
#include <cmath>

namespace eyebox::optics {
namespace {

constexpr double kGain = 5.555556;
constexpr double kBias = 0.047996;
constexpr double kScale = 0.244161;
constexpr double kShift = 0.386036;

}  // namespace

double LinearToLogC(double u) {
  const double argument = kGain * u + kBias;
  if (argument <= 0) return 0;
  return std::clamp(kScale * std::log10(argument) + kShift, 0.0, 1.0);
}

double LogCToLinear(double log_c) {
  return (std::pow(10.0, (log_c - kShift) / kScale) - kBias) / kGain;
}

}  // namespace eyebox::optics
