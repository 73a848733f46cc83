// Derivatives of the luminance by every parameter of an activation, as the fits use them.
#include <cmath>

#include "tests/tools/numerics/activation_shapes.h"
#include "tests/tools/numerics/worst_case.h"

namespace eyebox::numerics {
namespace {

Digits50& Cutoff(Shape50& shape) { return shape.cutoff; }
Digits50& Gamma(Shape50& shape) { return shape.gamma; }
Digits50& Toe(Shape50& shape) { return shape.toe; }

Digits50 ByLogSlope(const Shape50& shape, size_t knot, const Digits50& drive) {
  const Digits50 step("1e-17");
  Shape50 above = shape;
  Shape50 below = shape;
  above.log_slopes[knot] += step;
  below.log_slopes[knot] -= step;
  return (Luminance50(above, drive) - Luminance50(below, drive)) / (2 * step);
}

struct GradientCases {
  WorstCase range, cutoff, gamma, toe, warp;
};

void CompareGradient(const Shape& shape, double drive, GradientCases& cases) {
  const fit::Activation& a = shape.activation;
  const auto compare = [&](WorstCase& worst, double value, const Digits50& exact, double scale) {
    worst.Compare(value, exact,
                  {{"gamma", a.gamma},
                   {"v0", a.cutoff_drive},
                   {"toe", a.toe_drive},
                   {"knots", static_cast<double>(a.warp.Knots().size())},
                   {"v", drive}},
                  scale);
  };
  const std::array<double, 4> gradient = a.LuminanceGradient(drive);
  const Digits50 tiny("1e-17");
  const Digits50 small("1e-12");  // where the derivative itself is as small as 1 - v
  const Digits50 above_cutoff = Digits50(drive) - shape.exact.cutoff;
  const Digits50 h = Luminance50(shape.exact, drive);
  compare(cases.range, gradient[1], h, 1);
  compare(cases.cutoff, gradient[2], Derivative50(shape.exact, Cutoff, drive, above_cutoff * small),
          1);
  compare(cases.gamma, gradient[3], Derivative50(shape.exact, Gamma, drive, tiny), 1);
  if (a.warp.IsIdentity() && (a.toe_drive > 0 || a.gamma >= 1)) {
    const Digits50 step = (a.toe_drive > 0 ? shape.exact.toe : above_cutoff) * small;
    compare(cases.toe, a.LuminanceByToe(drive), Derivative50(shape.exact, Toe, drive, step), 1);
  }
  const std::vector<double> by_warp = a.LuminanceByWarp(drive);
  const double scale = a.gamma * static_cast<double>(h);
  for (size_t k = 0; k < by_warp.size() && scale > 1e-290; ++k) {
    compare(cases.warp, by_warp[k], ByLogSlope(shape.exact, k, drive), scale);
  }
}

// Where a formula of its own would give 0 log 0 or 0 / 0: no derivative may be anything but the
// limit that the header names.
void CompareAtSingularPoints(const Shape& shape, WorstCase& worst) {
  const fit::Activation& a = shape.activation;
  for (const double drive : {0.0, a.cutoff_drive}) {
    const std::array<double, 4> gradient = a.LuminanceGradient(drive);
    for (size_t i = 0; i < gradient.size(); ++i) {
      worst.Compare(gradient[i], i == 0 ? 1 : 0, {{"gamma", a.gamma}, {"v", drive}});
    }
    worst.Compare(a.LuminanceByToe(drive), 0, {{"gamma", a.gamma}, {"v", drive}});
    for (const double by_slope : a.LuminanceByWarp(drive)) {
      worst.Compare(by_slope, 0, {{"gamma", a.gamma}, {"v", drive}});
    }
  }
}

}  // namespace

void AddGradientRows(Density density, std::vector<Row>& rows) {
  GradientCases cases = {WorstCase("Activation::LuminanceGradient, by L1", 1e-12),
                         WorstCase("Activation::LuminanceGradient, by v0", 1e-12),
                         WorstCase("Activation::LuminanceGradient, by gamma", 1e-12),
                         WorstCase("Activation::LuminanceByToe", 1e-12),
                         WorstCase("Activation::LuminanceByWarp", 1e-12, Measure::kOfScale)};
  WorstCase singular("the same at v = 0 and v = v0", 0);
  for (const auto& shapes : {PlainShapes(density), WarpedShapes(density)}) {
    for (const Shape& shape : shapes) {
      for (const double drive : DrivesAbove(shape.activation.cutoff_drive, density)) {
        CompareGradient(shape, drive, cases);
      }
      CompareAtSingularPoints(shape, singular);
    }
  }
  for (const WorstCase* worst :
       {&cases.range, &cases.cutoff, &cases.gamma, &cases.toe, &cases.warp, &singular}) {
    rows.push_back(worst->row());
  }
}

}  // namespace eyebox::numerics
