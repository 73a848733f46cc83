#include "optics/render/stages.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "optics/render/log_c.h"
#include "optics/render/srgb.h"

namespace eyebox::optics {
namespace {

constexpr double kTop8Bit = 255;

template <typename Function>
Rgb PerChannel(const Rgb& colour, Function function) {
  return {function(colour[0]), function(colour[1]), function(colour[2])};
}

// Written so that NaN falls to 0.
double Saturated(double value) { return value > 0 ? std::min(value, 1.0) : 0.0; }

double Quantised(double value) { return std::floor(Saturated(value) * kTop8Bit + 0.5) / kTop8Bit; }

// In knots; linear in u between neighbours.
double KnotPosition(const std::vector<double>& knots_u, double u) {
  if (std::isnan(u)) return u;
  if (u <= knots_u.front()) return 0;
  if (u >= knots_u.back()) return static_cast<double>(knots_u.size() - 1);
  const auto above = std::upper_bound(knots_u.begin(), knots_u.end(), u);
  const double low = *(above - 1);
  return static_cast<double>(above - knots_u.begin() - 1) + (u - low) / (*above - low);
}

}  // namespace

Rgb EncodeSrgb::Apply(const Rgb& linear) const { return PerChannel(linear, LinearToSrgb); }

Rgb DecodeSrgb::Apply(const Rgb& encoded) const { return PerChannel(encoded, SrgbToLinear); }

Rgb Exposure::Apply(const Rgb& linear) const {
  const double factor = std::exp2(-stops);
  return PerChannel(linear, [factor](double value) { return value * factor; });
}

Rgb PackedFloatBuffer::Apply(const Rgb& linear) const {
  return {StoredAs(kFloat11, rounding, linear[0]), StoredAs(kFloat11, rounding, linear[1]),
          StoredAs(kFloat10, rounding, linear[2])};
}

Rgb HalfFloatBuffer::Apply(const Rgb& linear) const {
  return PerChannel(linear, [this](double value) { return StoredAs(kFloat16, rounding, value); });
}

Rgb SrgbBuffer::Apply(const Rgb& linear) const {
  return PerChannel(linear,
                    [](double value) { return SrgbToLinear(Quantised(LinearToSrgb(value))); });
}

Rgb QuantiseTo8Bits::Apply(const Rgb& encoded) const { return PerChannel(encoded, Quantised); }

Rgb DitherMean::Apply(const Rgb& encoded) const {
  return PerChannel(encoded, [this](double value) { return value + levels / kTop8Bit; });
}

Rgb Saturate::Apply(const Rgb& value) const { return PerChannel(value, Saturated); }

Rgb LogCTable::Apply(const Rgb& linear) const {
  const double last = table->size - 1;
  return SampleTrilinear(
      *table, PerChannel(linear, [last](double u) { return last * LinearToLogC(u); }), weight_bits);
}

Rgb KnotTable::Apply(const Rgb& linear) const {
  return SampleTrilinear(*table,
                         PerChannel(linear, [this](double u) { return KnotPosition(knots_u, u); }));
}

Rgb UniformTable::Apply(const Rgb& encoded) const {
  const double last = table->size - 1;
  return SampleTrilinear(*table,
                         PerChannel(encoded, [last](double value) { return last * value; }));
}

}  // namespace eyebox::optics
