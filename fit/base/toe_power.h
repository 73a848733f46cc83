// y^gamma, or the form of the sRGB transfer function: a straight toe that turns into a power with
// the same slope (models.md 5, H section 7.3).
#ifndef EYEBOX_FIT_BASE_TOE_POWER_H_
#define EYEBOX_FIT_BASE_TOE_POWER_H_

namespace eyebox::fit {

// P on [0, 1], P(0) = 0, P(1) = 1; gamma > 0, 0 <= b < 1. With a = b (gamma - 1) the power is
// ((y + a) / (1 + a))^gamma for y >= b; the tangent in b runs through 0, so that it is C1 with no
// further parameter. b = 0 is the plain power.
class ToePower {
 public:
  ToePower(double toe, double gamma);

  // y within [0, 1] and 1 - y, which has more digits near white.
  struct Place {
    double y = 0;
    double one_minus_y = 1;
  };

  double At(Place place) const;
  double Inverse(double p) const;  // 0 < p < 1
  // d(Inverse)/dp for 0 <= p <= 1, from p itself: y may be too small for a double where this is
  // not. Infinite at 0 for gamma > 1 without a toe.
  double InverseSlope(double p) const;
  // dP/dy; infinite at 0 for gamma < 1 without a toe.
  double Slope(Place place) const;
  double ByGamma(Place place) const;  // 0 at y = 0
  double ByToe(Place place) const;    // 0 at y = 0; towards larger b where b = 0

 private:
  double ByShift(Place place) const;  // dP/da above the toe
  bool InToe(Place place) const { return place.y < toe_; }

  double toe_;
  double gamma_;
  double shift_;      // a
  double toe_slope_;  // of the straight part
};

}  // namespace eyebox::fit

#endif  // EYEBOX_FIT_BASE_TOE_POWER_H_
