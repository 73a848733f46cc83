#include "optics/uniformity/chi_square.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace eyebox::optics {
namespace {

constexpr double kPrecision = 1e-16;
constexpr double kTiny = 1e-300;

// Terms that both expansions need: they converge in about the square root of a, near x = a.
int MostTerms(double a) { return 200 + static_cast<int>(20 * std::sqrt(a)); }

// x^a e^-x / Gamma(a), by Stirling's remainder where a is so large that logarithms would lose
// digits against each other.
double Front(double a, double x) {
  if (a < 20) return std::exp(a * std::log(x) - x - std::lgamma(a));
  const double t = (x - a) / a;
  const double a2 = a * a;
  const double remainder =
      (1.0 / 12 - (1.0 / 360 - (1.0 / 1260 - 1.0 / (1680 * a2)) / a2) / a2) / a;
  return std::sqrt(a / (2 * 3.14159265358979323846)) *
         std::exp(a * (std::log1p(t) - t) - remainder);
}

// P(a, x), for x below a + 1.
double LowerBySeries(double a, double x) {
  double term = 1 / a;
  double sum = term;
  for (int n = 1; n < MostTerms(a) && term > kPrecision * sum; ++n) {
    term *= x / (a + n);
    sum += term;
  }
  return Front(a, x) * sum;
}

// Q(a, x), for x from a + 1 on: continued fraction by Lentz's method.
double UpperByFraction(double a, double x) {
  double b = x + 1 - a;
  double c = 1 / kTiny;
  double d = 1 / b;
  double fraction = d;
  for (int n = 1; n < MostTerms(a); ++n) {
    const double numerator = -n * (n - a);
    b += 2;
    d = numerator * d + b;
    if (std::abs(d) < kTiny) d = kTiny;
    c = b + numerator / c;
    if (std::abs(c) < kTiny) c = kTiny;
    d = 1 / d;
    fraction *= d * c;
    if (std::abs(d * c - 1) < kPrecision) break;
  }
  return Front(a, x) * fraction;
}

}  // namespace

double ChiSquareSurvival(double chi2, double degrees_of_freedom) {
  if (std::isnan(chi2) || !(degrees_of_freedom > 0)) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  if (!(chi2 > 0)) return 1;
  if (std::isinf(chi2)) return 0;
  const double a = degrees_of_freedom / 2;
  const double x = chi2 / 2;
  const double q = x < a + 1 ? 1 - LowerBySeries(a, x) : UpperByFraction(a, x);
  return std::clamp(q, 0.0, 1.0);
}

}  // namespace eyebox::optics
