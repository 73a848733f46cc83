#include "fit/field/f_distribution.h"

#include <cmath>

namespace eyebox::fit {
namespace {

constexpr int kMostTerms = 100000;
constexpr double kTiny = 1e-300;

// Lentz's evaluation; quick for x below (a + 1) / (a + b + 2).
double BetaFraction(double x, double a, double b) {
  const auto away_from_zero = [](double value) { return std::abs(value) < kTiny ? kTiny : value; };
  double c = 1;
  double d = 1 / away_from_zero(1 - (a + b) * x / (a + 1));
  double fraction = d;
  for (int m = 1; m < kMostTerms; ++m) {
    const double even = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m));
    d = 1 / away_from_zero(1 + even * d);
    c = away_from_zero(1 + even / c);
    fraction *= d * c;
    const double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
    d = 1 / away_from_zero(1 + odd * d);
    c = away_from_zero(1 + odd / c);
    fraction *= d * c;
    if (std::abs(d * c - 1) < 1e-16) break;
  }
  return fraction;
}

// ln of x^a (1 - x)^b / B(a, b). Both x and 1 - x are given with all their digits.
double LogFront(double x, double one_minus_x, double a, double b) {
  return a * std::log(x) + b * std::log(one_minus_x) + std::lgamma(a + b) - std::lgamma(a) -
         std::lgamma(b);
}

// I_x(a, b).
double Beta(double x, double one_minus_x, double a, double b) {
  const double front = std::exp(LogFront(x, one_minus_x, a, b));
  if (x < (a + 1) / (a + b + 2)) return front * BetaFraction(x, a, b) / a;
  return 1 - front * BetaFraction(one_minus_x, b, a) / b;
}

}  // namespace

double FTail(double f, double numerator_freedom, double denominator_freedom) {
  if (!(f > 0)) return 1;
  if (std::isinf(f)) return 0;
  const double total = denominator_freedom + numerator_freedom * f;
  return Beta(denominator_freedom / total, numerator_freedom * f / total, denominator_freedom / 2,
              numerator_freedom / 2);
}

}  // namespace eyebox::fit
