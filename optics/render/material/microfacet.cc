#include "optics/render/material/microfacet.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace eyebox::optics {
namespace {

constexpr double kShaderDenominator = 1e-5;
constexpr double kLeastHalfCosine = 1e-100;

// a^2 + b^2 - 1 for a, b >= 0, also where it nearly vanishes: the squares with what their rounding
// leaves, the larger one less 1 first, which is exact where that matters.
double SquareSumMinusOne(double a, double b) {
  const double larger = std::max(a, b);
  const double smaller = std::min(a, b);
  const double larger2 = larger * larger;
  const double smaller2 = smaller * smaller;
  const double left = std::fma(larger, larger, -larger2) + std::fma(smaller, smaller, -smaller2);
  return (larger2 - 1) + smaller2 + left;
}

}  // namespace

double GgxDistribution(const Directions& d, double roughness) {
  const double a2 = roughness * roughness;
  const double spread = d.h_sin2 + a2 * d.n_h * d.n_h;
  return a2 / (std::numbers::pi * spread * spread);
}

double BeckmannDistribution(const Directions& d, double roughness) {
  if (d.n_h <= 0) return 0;
  const double cos2 = d.n_h * d.n_h;
  const double slope2 = d.h_sin2 / (cos2 * roughness * roughness);
  const double density = std::exp(-slope2) / (std::numbers::pi * roughness * roughness);
  // cos2^2 leaves the range of doubles only where the exponential has long vanished.
  return density > 0 ? density / (cos2 * cos2) : 0;
}

double SmithVisibility(double n_l, double n_v, double roughness) {
  if (n_l <= 0) return 0;
  const double a2 = roughness * roughness;
  const double view = std::sqrt(a2 + (1 - a2) * n_v * n_v);
  const double light = std::sqrt(a2 + (1 - a2) * n_l * n_l);
  return 0.5 / (view + n_v / n_l * light);
}

double SmithVisibilityApproximate(double n_l, double n_v, double roughness) {
  if (n_l <= 0) return 0;
  const double view = n_l * (n_v * (1 - roughness) + roughness);
  const double light = n_v * (n_l * (1 - roughness) + roughness);
  return 0.5 * n_l / (view + light + kShaderDenominator);
}

double CavityVisibility(const Directions& d) {
  if (d.n_l <= 0) return 0;
  const double masked = 2 * d.n_h / std::max(d.l_h, kLeastHalfCosine);
  const double shadowed = d.n_v > d.n_l ? masked * (d.n_l / d.n_v) : masked;
  return std::min(1 / d.n_v, shadowed) / 4;
}

double FresnelExact(double u, double index) {
  if (index == 1) return 0;
  const double contrast = (index - 1) * (index + 1);
  const double b2 = SquareSumMinusOne(index, u);
  if (b2 <= 0) return 1;
  const double b = std::sqrt(b2);
  // b - u, which would cancel for an index near 1.
  const double difference = contrast / (b + u);
  const double s = difference / (b + u);
  const double p = (u * (b + u) - 1) / (u * difference + 1);
  return 0.5 * s * s * (1 + p * p);
}

double Schlick5(double u) {
  const double w = 1 - u;
  return w * w * w * w * w;
}

double FresnelSchlick(double u, double f0) { return f0 + (1 - f0) * Schlick5(u); }

Rgb FresnelSchlick(double u, const Rgb& f0) {
  const double w = Schlick5(u);
  return {f0[0] + (1 - f0[0]) * w, f0[1] + (1 - f0[1]) * w, f0[2] + (1 - f0[2]) * w};
}

double DisneyDiffuse(const Directions& d, double perceptual_roughness) {
  const double rise = 2 * perceptual_roughness * d.l_h * d.l_h - 0.5;  // F90 - 1
  return (1 + rise * Schlick5(d.n_l)) * (1 + rise * Schlick5(d.n_v));
}

}  // namespace eyebox::optics
