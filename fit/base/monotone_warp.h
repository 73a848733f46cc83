// A rising C1 map of [0, 1] onto itself: what a gamma curve leaves of a display's answer.
#ifndef EYEBOX_FIT_BASE_MONOTONE_WARP_H_
#define EYEBOX_FIT_BASE_MONOTONE_WARP_H_

#include <span>
#include <vector>

namespace eyebox::fit {

// W(x) with W(0) = 0 and W(1) = 1. Its slope runs straight from knot to knot and is positive at
// each, so that W rises everywhere by construction (an I-spline of degree 2) and has an inverse in
// closed form. Without knots it is the identity.
class MonotoneWarp {
 public:
  struct Knot {
    double x = 0;
    double y = 0;      // W(x)
    double slope = 0;  // W'(x) > 0
    double rest = 0;   // 1 - W(x), summed from white, so that it has as many digits as y
    bool operator==(const Knot&) const = default;
  };

  MonotoneWarp() = default;
  // Slopes proportional to exp(log_slopes), scaled so that W(1) = 1: a constant added to all of
  // them changes nothing. `x` ascends from 0 to 1 exactly, two knots at least; as many log slopes,
  // finite and of magnitude below 300.
  static MonotoneWarp FromLogSlopes(std::span<const double> x, std::span<const double> log_slopes);
  // True if FromLogSlopes may be called with them.
  static bool IsValid(std::span<const double> x, std::span<const double> log_slopes);

  bool IsIdentity() const { return knots_.empty(); }
  const std::vector<Knot>& Knots() const { return knots_; }

  // All of them clamp to [0, 1]. Relative errors below 1e-15 times the number of knots; of
  // InverseAt, those of a y that is off by as much.
  double At(double x) const;
  double OneMinusAt(double one_minus_x) const;  // 1 - W
  double SlopeAt(double x) const;               // W'
  double InverseAt(double y) const;
  // dW/d(log slope) at x of each knot, [knots].
  std::vector<double> ByLogSlopes(double x) const;

  bool operator==(const MonotoneWarp&) const = default;

 private:
  // The knot at which the piece begins that holds the place.
  size_t PieceOf(double x) const;

  std::vector<Knot> knots_;
};

}  // namespace eyebox::fit

#endif  // EYEBOX_FIT_BASE_MONOTONE_WARP_H_
