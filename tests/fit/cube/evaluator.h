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

}  // namespace eyebox::fit::evaluator

#endif  // EYEBOX_TESTS_FIT_CUBE_EVALUATOR_H_
