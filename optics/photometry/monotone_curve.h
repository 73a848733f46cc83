// A smooth curve through rising points that never turns back, and its exact inverse.
#ifndef EYEBOX_OPTICS_PHOTOMETRY_MONOTONE_CURVE_H_
#define EYEBOX_OPTICS_PHOTOMETRY_MONOTONE_CURVE_H_

#include <optional>
#include <span>
#include <vector>

#include "absl/status/statusor.h"

namespace eyebox::optics {

// Piecewise cubic with continuous slope, through its knots (PCHIP: Fritsch and Carlson 1980 with
// the harmonic slopes of Fritsch and Butland 1984), strictly rising in between.
class MonotoneCurve {
 public:
  // Errors: InvalidArgument (fewer than 2 knots, other lengths, x or y not strictly rising).
  static absl::StatusOr<MonotoneCurve> Through(std::vector<double> x, std::vector<double> y);

  // Nothing outside the knots, or for NaN: a curve knows nothing there.
  std::optional<double> At(double x) const;
  std::optional<double> SlopeAt(double x) const;
  // The x at which the curve is y: At() leads back to within 1e-13 of the range of y.
  std::optional<double> InverseAt(double y) const;

  std::span<const double> KnotsX() const { return x_; }
  std::span<const double> KnotsY() const { return y_; }

 private:
  struct Value {
    double y = 0;
    double slope = 0;
  };
  Value In(size_t piece, double x) const;

  std::vector<double> x_, y_, slope_;
};

// Weighted least squares among rising sequences (pool adjacent violators): values that would fall
// are pooled into their mean. `weight` above 0; one entry a value.
std::vector<double> Isotonic(std::span<const double> value, std::span<const double> weight);

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_PHOTOMETRY_MONOTONE_CURVE_H_
