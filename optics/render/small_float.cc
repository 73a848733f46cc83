#include "optics/render/small_float.h"

#include <bit>
#include <cmath>
#include <limits>

namespace eyebox::optics {
namespace {

constexpr int kExponentBits = 5;
constexpr int kBias = 15;
constexpr int kDoubleMantissaBits = 52;
constexpr double kSmallestNormal = 0x1p-14;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr uint32_t kTopExponent = (1u << kExponentBits) - 1;

// Of a magnitude: multiples of the format's step at its exponent.
double CutToStep(int mantissa_bits, Rounding rounding, double size) {
  if (size < kSmallestNormal) {
    const double steps = std::ldexp(size, kBias - 1 + mantissa_bits);
    const double kept = rounding == Rounding::kTruncate ? std::trunc(steps) : std::rint(steps);
    return std::ldexp(kept, 1 - kBias - mantissa_bits);
  }
  // The bits of a double are ordered like its magnitude, so a carry out of the mantissa is right.
  const int dropped = kDoubleMantissaBits - mantissa_bits;
  auto bits = std::bit_cast<uint64_t>(size);
  if (rounding == Rounding::kNearestEven) {
    const uint64_t is_odd = (bits >> dropped) & 1;
    bits += (uint64_t{1} << (dropped - 1)) - 1 + is_odd;
  }
  return std::bit_cast<double>(bits >> dropped << dropped);
}

}  // namespace

double StoredAs(SmallFloat format, Rounding rounding, double value) {
  if (std::isnan(value)) return value;
  if (!format.has_sign && value <= 0) return 0;
  const double size = std::abs(value);
  double stored = size;
  if (size != kInfinity) {
    const double largest = std::ldexp(2 - std::ldexp(1.0, -format.mantissa_bits), kBias);
    stored = CutToStep(format.mantissa_bits, rounding, size);
    if (stored > largest) stored = rounding == Rounding::kTruncate ? largest : kInfinity;
  }
  return std::copysign(stored, value);
}

uint32_t EncodeSmallFloat(SmallFloat format, Rounding rounding, double value) {
  const int mantissa_bits = format.mantissa_bits;
  if (std::isnan(value)) return (kTopExponent << mantissa_bits) | (1u << (mantissa_bits - 1));
  const double stored = StoredAs(format, rounding, value);
  const double size = std::abs(stored);
  const uint32_t sign = std::signbit(stored) ? 1u << (mantissa_bits + kExponentBits) : 0;
  if (size == kInfinity) return sign | (kTopExponent << mantissa_bits);
  if (size < kSmallestNormal) {
    return sign | static_cast<uint32_t>(std::ldexp(size, kBias - 1 + mantissa_bits));
  }
  const int exponent = std::ilogb(size);
  const auto steps = static_cast<uint32_t>(std::ldexp(size, mantissa_bits - exponent));
  return sign + (static_cast<uint32_t>(exponent + kBias - 1) << mantissa_bits) + steps;
}

double DecodeSmallFloat(SmallFloat format, uint32_t bits) {
  const int mantissa_bits = format.mantissa_bits;
  const uint32_t mantissa = bits & ((1u << mantissa_bits) - 1);
  const uint32_t exponent = (bits >> mantissa_bits) & kTopExponent;
  const bool is_negative = format.has_sign && ((bits >> (mantissa_bits + kExponentBits)) & 1) != 0;
  double size = 0;
  if (exponent == kTopExponent) {
    if (mantissa != 0) return std::numeric_limits<double>::quiet_NaN();
    size = kInfinity;
  } else if (exponent == 0) {
    size = std::ldexp(mantissa, 1 - kBias - mantissa_bits);
  } else {
    size = std::ldexp((1u << mantissa_bits) + mantissa,
                      static_cast<int>(exponent) - kBias - mantissa_bits);
  }
  return is_negative ? -size : size;
}

}  // namespace eyebox::optics
