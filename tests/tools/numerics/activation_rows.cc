// Activation and MonotoneWarp: values, inverses and slopes.
#include "fit/base/monotone_warp.h"
#include "tests/tools/numerics/activation_shapes.h"
#include "tests/tools/numerics/worst_case.h"

namespace eyebox::numerics {
namespace {

struct ActivationCases {
  WorstCase h, luminance, inverse, slope, inverse_slope;
};

using Function50 = Digits50 (*)(const Shape50&, const Digits50&);

// Of f and of what it changes by where its argument t changes by its own size: errors of that share
// are those of an argument that is off by the same share of itself.
double ScaleOf(Function50 f, const Shape50& shape, const Digits50& t) {
  const Digits50 share("1e-9");
  const Digits50 change = (f(shape, t + t * share) - f(shape, t - t * share)) / (2 * share);
  return static_cast<double>(abs(f(shape, t)) + abs(change));
}

void CompareAt(WorstCase& worst, double value, Function50 exact, const Shape& shape,
               const char* name, double argument) {
  const fit::Activation& a = shape.activation;
  const bool of_scale = worst.row().measure == Measure::kOfScale;
  worst.Compare(value, exact(shape.exact, argument),
                {{"gamma", a.gamma},
                 {"v0", a.cutoff_drive},
                 {"toe", a.toe_drive},
                 {"knots", static_cast<double>(a.warp.Knots().size())},
                 {name, argument}},
                of_scale ? ScaleOf(exact, shape.exact, argument) : 1);
}

constexpr double kMinimum = 0.775;
constexpr double kRange = 420.3;

Digits50 LitLuminance50(const Shape50& shape, const Digits50& drive) {
  return Digits50(kMinimum) + Digits50(kRange) * Luminance50(shape, drive);
}

void CompareAtDrive(const Shape& shape, double drive, ActivationCases& cases) {
  fit::Activation lit = shape.activation;
  lit.minimum_luminance = kMinimum;
  lit.luminance_range = kRange;
  CompareAt(cases.h, shape.activation.H(drive), Luminance50, shape, "v", drive);
  CompareAt(cases.luminance, lit.Luminance(drive), LitLuminance50, shape, "v", drive);
  CompareAt(cases.slope, shape.activation.Slope(drive), Slope50, shape, "v", drive);
}

void CompareAtActivation(const Shape& shape, double h, ActivationCases& cases) {
  CompareAt(cases.inverse, shape.activation.InverseH(h), Inverse50, shape, "h", h);
  CompareAt(cases.inverse_slope, shape.activation.InverseSlope(h), InverseSlope50, shape, "h", h);
}

void AddActivation(const char* kind, double promised_h, Measure of_inverse,
                   const std::vector<Shape>& shapes, Density density, std::vector<Row>& rows) {
  const auto named = [&](const char* member, double promised, Measure measure) {
    return WorstCase(std::string("Activation::") + member + ", " + kind, promised, measure);
  };
  ActivationCases cases = {
      named("H", promised_h, Measure::kRelative),
      named("Luminance", promised_h, Measure::kRelative), named("InverseH", 1e-12, of_inverse),
      named("Slope", 1e-12, Measure::kRelative), named("InverseSlope", 1e-12, of_inverse)};
  std::vector<double> activations = {1e-300, 1};
  for (const double share : LogSteps(1e-12, 0.5, 7 * density.steps)) {
    activations.insert(activations.end(), {share, 1 - share});
  }
  for (const Shape& shape : shapes) {
    for (const double drive : DrivesAbove(shape.activation.cutoff_drive, density)) {
      CompareAtDrive(shape, drive, cases);
    }
    for (const double h : activations) CompareAtActivation(shape, h, cases);
  }
  for (const WorstCase* worst :
       {&cases.h, &cases.luminance, &cases.inverse, &cases.slope, &cases.inverse_slope}) {
    rows.push_back(worst->row());
  }
}

}  // namespace

void AddActivationRows(Density density, std::vector<Row>& rows) {
  AddActivation("gamma and toe", 1e-14, Measure::kRelative, PlainShapes(density), density, rows);
  AddActivation("spline", 1e-13, Measure::kOfScale, WarpedShapes(density), density, rows);
}

}  // namespace eyebox::numerics
