// Activations over the extreme grid, and their luminance in 50 digits.
#ifndef EYEBOX_TESTS_TOOLS_NUMERICS_ACTIVATION_SHAPES_H_
#define EYEBOX_TESTS_TOOLS_NUMERICS_ACTIVATION_SHAPES_H_

#include <vector>

#include "fit/base/activation.h"
#include "tests/tools/numerics/digits.h"
#include "tests/tools/numerics/worst_case.h"

namespace eyebox::numerics {

// The parameters in 50 digits; a warp by its knots and log slopes, as it was made.
struct Shape50 {
  Digits50 minimum = 0;
  Digits50 range = 1;
  Digits50 cutoff = 0;
  Digits50 gamma = 1;
  Digits50 toe = 0;
  std::vector<Digits50> knots;
  std::vector<Digits50> log_slopes;
};

struct Shape {
  fit::Activation activation;
  Shape50 exact;
};

// gamma 0.3 to 8, v0 0 to 0.99, toe 0 to 0.9, warps of 2 to 9 knots; L0 and L1 0 and 1.
std::vector<Shape> PlainShapes(Density density);   // no warp
std::vector<Shape> WarpedShapes(Density density);  // no toe, as the fit makes them

// Just above the cutoff, dense at both ends, to 1.
std::vector<double> DrivesAbove(double cutoff, Density density);

Digits50 Luminance50(const Shape50& shape, const Digits50& drive);
// The drive at which h is `activation`.
Digits50 Inverse50(const Shape50& shape, const Digits50& activation);
// dv/dh by the central difference of the place above the cutoff, which keeps all digits near it.
Digits50 InverseSlope50(const Shape50& shape, const Digits50& activation);
// dh/dv by the central difference of Luminance50.
Digits50 Slope50(const Shape50& shape, const Digits50& drive);
// dL/dp by the central difference; `step` of p.
Digits50 Derivative50(const Shape50& shape, Digits50& (*parameter)(Shape50&), const Digits50& drive,
                      const Digits50& step);

}  // namespace eyebox::numerics

#endif  // EYEBOX_TESTS_TOOLS_NUMERICS_ACTIVATION_SHAPES_H_
