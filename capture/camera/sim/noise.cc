#include "capture/camera/sim/noise.h"

#include <cmath>
#include <numbers>

namespace eyebox::capture {
namespace {

constexpr double kSmallMean = 10;

// Knuth 1969: count uniforms until their product falls below exp(-mean).
int64_t PoissonByProduct(RandomStream& stream, double mean) {
  const double limit = std::exp(-mean);
  int64_t events = 0;
  for (double product = stream.Uniform(); product > limit; product *= stream.Uniform()) ++events;
  return events;
}

// Hoermann, "The transformed rejection method for generating Poisson random variables", 1993,
// algorithm PTRS. The hat is the ratio-of-uniforms density with these constants.
int64_t PoissonByRejection(RandomStream& stream, double mean) {
  const double log_mean = std::log(mean);
  const double b = 0.931 + 2.53 * std::sqrt(mean);
  const double a = -0.059 + 0.02483 * b;
  const double inverse_alpha = 1.1239 + 1.1328 / (b - 3.4);
  const double squeeze = 0.9277 - 3.6224 / (b - 2);
  while (true) {
    const double u = stream.Uniform() - 0.5;
    const double v = stream.Uniform();
    const double us = 0.5 - std::abs(u);
    const double k = std::floor((2 * a / us + b) * u + mean + 0.43);
    if (us >= 0.07 && v <= squeeze) return static_cast<int64_t>(k);
    if (k < 0 || (us < 0.013 && v > us)) continue;
    const double log_hat = std::log(v * inverse_alpha / (a / (us * us) + b));
    if (log_hat <= k * log_mean - mean - LogFactorial(k)) return static_cast<int64_t>(k);
  }
}

}  // namespace

double LogFactorial(double k) {
  if (k < 10) {
    double factorial = 1;
    for (double i = 2; i <= k; ++i) factorial *= i;
    return std::log(factorial);
  }
  const double r = 1 / k;
  const double series = r / 12 - r * r * r / 360 + r * r * r * r * r / 1260;
  return k * std::log(k) - k + 0.5 * std::log(2 * std::numbers::pi * k) + series;
}

double NoiseSource::Gaussian() {
  has_spare_ = !has_spare_;
  if (!has_spare_) return spare_;
  const double radius = std::sqrt(-2 * std::log(stream_.Uniform()));
  const double angle = 2 * std::numbers::pi * stream_.Uniform();
  spare_ = radius * std::sin(angle);
  return radius * std::cos(angle);
}

int64_t NoiseSource::Poisson(double mean) {
  return mean < kSmallMean ? PoissonByProduct(stream_, mean) : PoissonByRejection(stream_, mean);
}

}  // namespace eyebox::capture
