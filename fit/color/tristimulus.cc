#include "fit/color/tristimulus.h"

#include <cmath>
#include <limits>

namespace eyebox::fit {
namespace {

double Determinant(const Xyz& a, const Xyz& b, const Xyz& c) {
  return a[0] * (b[1] * c[2] - b[2] * c[1]) - b[0] * (a[1] * c[2] - a[2] * c[1]) +
         c[0] * (a[1] * b[2] - a[2] * b[1]);
}

}  // namespace

UniformChromaticity UniformChromaticityOf(const Xyz& colour) {
  const double sum = colour[0] + 15 * colour[1] + 3 * colour[2];
  if (!(sum > 0)) {
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    return {kNone, kNone};
  }
  return {4 * colour[0] / sum, 9 * colour[1] / sum};
}

double ChromaticityDistance(const Xyz& a, const Xyz& b) {
  const UniformChromaticity of_a = UniformChromaticityOf(a);
  const UniformChromaticity of_b = UniformChromaticityOf(b);
  return std::hypot(of_a.u - of_b.u, of_a.v - of_b.v);
}

Chromaticity ChromaticityOf(const Xyz& colour) {
  const double sum = colour[0] + colour[1] + colour[2];
  return {colour[0] / sum, colour[1] / sum};
}

Xyz ColourOf(const Chromaticity& chromaticity, double luminance) {
  const double scale = luminance / chromaticity.y;
  return {chromaticity.x * scale, luminance, (1 - chromaticity.x - chromaticity.y) * scale};
}

Xyz Combine(const std::array<Xyz, 3>& columns, const Rgb& weights) {
  Xyz sum{};
  for (size_t k = 0; k < 3; ++k) {
    for (size_t c = 0; c < 3; ++c) sum[c] += weights[k] * columns[k][c];
  }
  return sum;
}

Rgb WeightsFor(const std::array<Xyz, 3>& columns, const Xyz& wanted) {
  const auto& [a, b, c] = columns;
  const double whole = Determinant(a, b, c);
  return {Determinant(wanted, b, c) / whole, Determinant(a, wanted, c) / whole,
          Determinant(a, b, wanted) / whole};
}

Xyz Minus(const Xyz& a, const Xyz& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

Xyz Plus(const Xyz& a, const Xyz& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }

}  // namespace eyebox::fit
