#include "tests/tools/numerics/activation_shapes.h"

#include <algorithm>
#include <cmath>

namespace eyebox::numerics {
namespace {

// Integral of the slope, straight from knot to knot, up to x; not scaled to W(1) = 1. The last
// piece goes on beyond 1, for differences at white.
Digits50 Area50(const Shape50& shape, const Digits50& x) {
  Digits50 area = 0;
  for (size_t i = 0; i + 1 < shape.knots.size(); ++i) {
    const Digits50& from = shape.knots[i];
    const Digits50& to = shape.knots[i + 1];
    if (x <= from) break;
    const Digits50 t = (x < to || i + 2 == shape.knots.size() ? x : to) - from;
    const Digits50 slope = exp(shape.log_slopes[i]);
    const Digits50 next = exp(shape.log_slopes[i + 1]);
    area += t * slope + (next - slope) * t * t / (2 * (to - from));
  }
  return area;
}

Digits50 Warp50(const Shape50& shape, const Digits50& x) {
  return shape.knots.empty() ? x : Area50(shape, x) / Area50(shape, 1);
}

Digits50 WarpInverse50(const Shape50& shape, const Digits50& y) {
  if (shape.knots.empty()) return y;
  const Digits50 area = y * Area50(shape, 1);
  size_t piece = 0;
  while (piece + 2 < shape.knots.size() && area >= Area50(shape, shape.knots[piece + 1])) ++piece;
  const Digits50 slope = exp(shape.log_slopes[piece]);
  const Digits50 bend =
      (exp(shape.log_slopes[piece + 1]) - slope) / (shape.knots[piece + 1] - shape.knots[piece]);
  const Digits50 rise = area - Area50(shape, shape.knots[piece]);
  return shape.knots[piece] + 2 * rise / (slope + sqrt(slope * slope + 2 * bend * rise));
}

// The toe's slope is that of the tangent, so that h is its height at the toe over the toe.
Digits50 Power50(const Shape50& shape, const Digits50& y) {
  const Digits50 a = shape.toe * (shape.gamma - 1);
  if (y < shape.toe) {
    return pow(Digits50((shape.toe + a) / (1 + a)), shape.gamma) / shape.toe * y;
  }
  return pow(Digits50((y + a) / (1 + a)), shape.gamma);
}

Shape MakeShape(double cutoff, double gamma, double toe, const std::vector<double>& x,
                const std::vector<double>& log_slopes) {
  Shape shape;
  shape.activation = {0, 1, cutoff, gamma, toe};
  if (!x.empty()) shape.activation.warp = fit::MonotoneWarp::FromLogSlopes(x, log_slopes);
  shape.exact.cutoff = cutoff;
  shape.exact.gamma = gamma;
  shape.exact.toe = toe;
  shape.exact.knots.assign(x.begin(), x.end());
  shape.exact.log_slopes.assign(log_slopes.begin(), log_slopes.end());
  return shape;
}

std::vector<double> Gammas(Density density) {
  std::vector<double> gammas = {0.3, 1, 2.2, 3.071, 8};
  if (density.steps > 1) gammas.insert(gammas.end(), {0.5, 0.9, 1.8, 2.4, 2.6, 5});
  return gammas;
}

std::vector<double> Cutoffs(Density density) {
  std::vector<double> cutoffs = {0, 0.0335, 0.99};
  if (density.steps > 1) cutoffs.insert(cutoffs.end(), {1e-9, 1e-3, 0.5});
  return cutoffs;
}

// The place between cutoff (0) and white (1) at which h is `activation`.
Digits50 InverseBase50(const Shape50& shape, const Digits50& activation) {
  const Digits50 a = shape.toe * (shape.gamma - 1);
  Digits50 y = (1 + a) * pow(activation, Digits50(1 / shape.gamma)) - a;
  if (y < shape.toe) y = shape.toe * activation / Power50(shape, shape.toe);
  return WarpInverse50(shape, y);
}

}  // namespace

std::vector<Shape> PlainShapes(Density density) {
  std::vector<Shape> shapes;
  for (const double gamma : Gammas(density)) {
    for (const double cutoff : Cutoffs(density)) {
      for (const double toe : {0.0, 1e-6, 0.0393, 0.9}) {
        // With gamma below 1 a toe would have to bend the other way.
        if (toe == 0 || gamma >= 1) shapes.push_back(MakeShape(cutoff, gamma, toe, {}, {}));
      }
    }
  }
  return shapes;
}

std::vector<Shape> WarpedShapes(Density density) {
  const std::vector<std::vector<double>> warps = {
      {0, 0},  {-2, 2}, {0.3, -0.1, 0.2},           {20, -20, 0, 5},
      {-5, 0}, {8, 0},  {0.1, 0.2, -0.3, 0.1, 0.4}, {3, -3, 3, -3, 3, -3, 3, -3, 3}};
  std::vector<Shape> shapes;
  for (const auto& log_slopes : warps) {
    std::vector<double> x;
    const double last = static_cast<double>(log_slopes.size()) - 1;
    for (size_t i = 0; i < log_slopes.size(); ++i) {
      x.push_back(std::pow(static_cast<double>(i) / last, 1.5));
    }
    for (const double gamma : Gammas(density)) {
      for (const double cutoff : Cutoffs(density)) {
        shapes.push_back(MakeShape(cutoff, gamma, 0, x, log_slopes));
      }
    }
  }
  return shapes;
}

std::vector<double> DrivesAbove(double cutoff, Density density) {
  std::vector<double> drives = {std::max(std::nextafter(cutoff, 1.0), 1e-300),
                                std::nextafter(1.0, 0.0), 1};
  for (const double share : LogSteps(1e-12, 0.5, 9 * density.steps)) {
    drives.push_back(cutoff + share * (1 - cutoff));
    drives.push_back(1 - share * (1 - cutoff));
  }
  return drives;
}

Digits50 Luminance50(const Shape50& shape, const Digits50& drive) {
  const Digits50 x = (drive - shape.cutoff) / (1 - shape.cutoff);
  if (x <= 0) return shape.minimum;
  return shape.minimum + shape.range * Power50(shape, Warp50(shape, x));
}

Digits50 Inverse50(const Shape50& shape, const Digits50& activation) {
  return shape.cutoff + (1 - shape.cutoff) * InverseBase50(shape, activation);
}

Digits50 InverseSlope50(const Shape50& shape, const Digits50& activation) {
  const Digits50 step = activation * Digits50("1e-17");
  return (1 - shape.cutoff) *
         (InverseBase50(shape, activation + step) - InverseBase50(shape, activation - step)) /
         (2 * step);
}

Digits50 Slope50(const Shape50& shape, const Digits50& drive) {
  const Digits50 step = (drive - shape.cutoff) * Digits50("1e-17");
  return (Luminance50(shape, drive + step) - Luminance50(shape, drive - step)) / (2 * step);
}

Digits50 Derivative50(const Shape50& shape, Digits50& (*parameter)(Shape50&), const Digits50& drive,
                      const Digits50& step) {
  Shape50 above = shape;
  Shape50 below = shape;
  parameter(above) += step;
  parameter(below) -= step;
  return (Luminance50(above, drive) - Luminance50(below, drive)) / (2 * step);
}

}  // namespace eyebox::numerics
