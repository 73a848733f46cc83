#include "optics/render/srgb.h"

#include <cmath>

namespace eyebox::optics {
namespace {

constexpr double kEncodedBreak = 0.04045;
constexpr double kLinearBreak = 0.0031308;
constexpr double kSlope = 12.92;
constexpr double kOffset = 0.055;
constexpr double kExponent = 2.4;

}  // namespace

double SrgbToLinear(double encoded) {
  const double size = std::abs(encoded);
  if (size <= kEncodedBreak) return encoded / kSlope;
  return std::copysign(std::pow((size + kOffset) / (1 + kOffset), kExponent), encoded);
}

double LinearToSrgb(double linear) {
  const double size = std::abs(linear);
  if (size <= kLinearBreak) return linear * kSlope;
  return std::copysign((1 + kOffset) * std::pow(size, 1 / kExponent) - kOffset, linear);
}

}  // namespace eyebox::optics
