// CIE 1931 tristimulus values and what is derived of them.
#ifndef EYEBOX_FIT_COLOR_TRISTIMULUS_H_
#define EYEBOX_FIT_COLOR_TRISTIMULUS_H_

#include <array>

namespace eyebox::fit {

using Xyz = std::array<double, 3>;  // X, Y, Z; Y in cd/m2, or all three relative
using Rgb =
    std::array<double, 3>;  // red, green, blue: drive values, activations or rendered values
using Matrix3 = std::array<std::array<double, 3>, 3>;  // [row][column]

constexpr std::array<const char*, 3> kChannelNames = {"red", "green", "blue"};

// CIE 1976 u', v' (CIE 015:2018, 8.2.1).
struct UniformChromaticity {
  double u = 0;
  double v = 0;
};

// Of a colour with X + 15 Y + 3 Z > 0, else NaN.
UniformChromaticity UniformChromaticityOf(const Xyz& colour);
// Euclidean distance in u', v'; NaN if either colour has no chromaticity. About 0.004 is just
// noticeable side by side.
double ChromaticityDistance(const Xyz& a, const Xyz& b);

// CIE 1931 x, y.
struct Chromaticity {
  double x = 0;
  double y = 0;
};
Chromaticity ChromaticityOf(const Xyz& colour);
// The colour of this chromaticity with Y = `luminance`; y must not be 0.
Xyz ColourOf(const Chromaticity& chromaticity, double luminance);

// Sum over k of weights[k] * columns[k].
Xyz Combine(const std::array<Xyz, 3>& columns, const Rgb& weights);
// The weights with which `columns` add up to `wanted`; not finite if the columns are dependent.
Rgb WeightsFor(const std::array<Xyz, 3>& columns, const Xyz& wanted);
Xyz Minus(const Xyz& a, const Xyz& b);
Xyz Plus(const Xyz& a, const Xyz& b);

}  // namespace eyebox::fit

#endif  // EYEBOX_FIT_COLOR_TRISTIMULUS_H_
