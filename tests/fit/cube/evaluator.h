// What a display shows through a table file, computed without any of the designer's code: own
// sampling axes, own sRGB transfer, own activation, own trilinear look-up; in long double.
#ifndef EYEBOX_TESTS_FIT_CUBE_EVALUATOR_H_
#define EYEBOX_TESTS_FIT_CUBE_EVALUATOR_H_

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <vector>

#include "fit/cube/table_file.h"

namespace eyebox::fit::evaluator {

using Real = long double;
using Triplet = std::array<Real, 3>;

struct Display {
  Real minimum = 0;
  Real range = 1;
  Real cutoff = 0;
  Real gamma = 2.2L;

  Real Luminance(Real drive) const {
    const Real v = std::clamp<Real>(drive, 0, 1);
    const Real h = v <= cutoff ? 0 : std::pow((v - cutoff) / (1 - cutoff), gamma);
    return minimum + range * h;
  }
  Real Wanted(Real x) const { return std::max((minimum + range) * x, minimum); }
};

inline Activation ActivationOf(const Display& display) {
  return {static_cast<double>(display.minimum), static_cast<double>(display.range),
          static_cast<double>(display.cutoff), static_cast<double>(display.gamma)};
}

inline Real HdrpAxis(Real u) {
  const Real inside = std::max<Real>(5.555556L * u + 0.047996L, 1e-30L);
  return std::clamp<Real>(0.244161L * std::log10(inside) + 0.386036L, 0, 1);
}

inline Real UniformAxis(Real u) { return std::clamp<Real>(u, 0, 1); }

inline Real EncodeSrgb(Real linear) {
  return linear > 0.0031308L ? 1.055L * std::pow(linear, 1 / 2.4L) - 0.055L : 12.92L * linear;
}

// Trilinear, `axis` in [0, 1] per channel; red fastest.
inline Triplet LookUp(const Cube3d& cube, const Triplet& axis) {
  std::array<int, 3> corner{};
  Triplet share{};
  for (size_t c = 0; c < 3; ++c) {
    const Real position = axis[c] * (cube.size - 1);
    corner[c] = std::min(static_cast<int>(position), cube.size - 2);
    share[c] = position - corner[c];
  }
  Triplet sum{};
  for (int k = 0; k < 8; ++k) {
    Real weight = 1;
    size_t index = 0;
    for (int c = 2; c >= 0; --c) {
      const int up = (k >> c) & 1;
      weight *= up ? share[c] : 1 - share[c];
      index = index * static_cast<size_t>(cube.size) + static_cast<size_t>(corner[c] + up);
    }
    for (size_t c = 0; c < 3; ++c) sum[c] += weight * cube.entries[index][c];
  }
  return sum;
}

inline Triplet Drive(const Cube3d& cube, TableTarget target, const Triplet& u) {
  Triplet axis{};
  for (size_t c = 0; c < 3; ++c) {
    axis[c] = target == TableTarget::kHdrp ? HdrpAxis(u[c]) : UniformAxis(u[c]);
  }
  Triplet drive = LookUp(cube, axis);
  for (Real& v : drive) {
    v = std::clamp<Real>(target == TableTarget::kHdrp ? EncodeSrgb(v) : v, 0, 1);
  }
  return drive;
}

struct Errors {
  Real worst = 0;
  Real rms = 0;
  Real at = 0;
};

// Over x in [from, 1], evenly in log x, of any way from x to a drive value.
inline Errors Measure(const Display& display, Real from, int samples,
                      const std::function<Real(Real)>& drive_at) {
  Errors errors;
  for (int i = 0; i < samples; ++i) {
    const Real x = std::pow(from, 1 - static_cast<Real>(i) / (samples - 1));
    const Real error = display.Luminance(drive_at(x)) / display.Wanted(x) - 1;
    errors.rms += error * error / samples;
    if (std::abs(error) <= errors.worst) continue;
    errors.worst = std::abs(error);
    errors.at = x;
  }
  errors.rms = std::sqrt(errors.rms);
  return errors;
}

// Of grey through the green channel of `cube`.
inline Errors Measure(const Display& display, const Cube3d& cube, TableTarget target, Real white_u,
                      Real from, int samples) {
  return Measure(display, from, samples, [&](Real x) {
    const Real u = x * white_u;
    return Drive(cube, target, {u, u, u})[1];
  });
}

// u_i of table 2(b) of the HDRP model paper (its eighth, misprinted, as monotonicity demands).
inline constexpr std::array<Real, 32> kPublishedKnots = {
    -1,      0,       1.657e-9, 0.002830, 0.007137, 0.01269, 0.02051, 0.03086,
    0.04479, 0.06444, 0.08989,  0.1252,   0.1726,   0.2370,  0.3253,  0.4422,
    0.6039,  0.8207,  1.104,    1.495,    2.032,    2.756,   3.738,   5.083,
    6.864,   9.347,   12.62,    17.18,    23.24,    31.48,   42.75,   57.66};

inline Real Ideal(const Display& display, Real x) {
  const Real w = display.minimum / display.range;
  const Real h = std::max<Real>((1 + w) * x - w, 0);
  const Real v = display.cutoff + (1 - display.cutoff) * std::pow(h, 1 / display.gamma);
  return v <= 0.04045L ? v / 12.92L : std::pow((v + 0.055L) / 1.055L, 2.4L);
}

// The published method: f at its knots, continued above white, as the renderer samples it.
inline Errors PublishedMethod(const Display& display, Real from, int samples) {
  return Measure(display, from, samples, [&](Real u) {
    const Real position = 31 * HdrpAxis(u);
    const size_t below = static_cast<size_t>(position);
    const Real share = position - static_cast<Real>(below);
    return EncodeSrgb((1 - share) * Ideal(display, kPublishedKnots[below]) +
                      share * Ideal(display, kPublishedKnots[below + 1]));
  });
}

}  // namespace eyebox::fit::evaluator

#endif  // EYEBOX_TESTS_FIT_CUBE_EVALUATOR_H_
