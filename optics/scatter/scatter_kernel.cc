#include "optics/scatter/scatter_kernel.h"

#include <cmath>
#include <numbers>
#include <utility>

#include "absl/strings/str_cat.h"
#include "capture/base/status.h"

namespace eyebox::optics {
namespace {

constexpr double kExponentMin = 0.1;
constexpr double kExponentMax = 40;
constexpr double kGaussianEnd = 9;  // core radii: exp(-9^2 / 2) is below the rounding of 1

// Integral of u^(k - 1) over u from 1 to q, given log q; the logarithm at k = 0. expm1 keeps all
// digits however small its argument, until products leave the range of doubles.
double PowerIntegral(double k, double log_q) {
  return std::abs(k) < 1e-18 ? log_q : std::expm1(k * log_q) / k;
}

// Its derivative by k.
double PowerIntegralSlope(double k, double log_q) {
  const double x = k * log_q;
  if (std::abs(x) > 0.1) return (x * std::exp(x) - std::expm1(x)) / (k * k);
  // The sum of x^n / (n! (n + 2)): the difference above loses its digits.
  double sum = 0;
  double power = 1;
  for (int n = 0; n < 12; ++n) {
    sum += power / (n + 2);
    power *= x / (n + 1);
  }
  return sum * log_q * log_q;
}

PartEnergy Normalised(const PartEnergy& part, const PartEnergy& whole) {
  const double energy = part.energy / whole.energy;
  return {energy, (part.by_radius - energy * whole.by_radius) / whole.energy,
          (part.by_exponent - energy * whole.by_exponent) / whole.energy};
}

}  // namespace

absl::Status ScatterKernel::Validate() const {
  const auto bad = [](const char* field, double value, const char* remedy) {
    return BadInput(absl::StrCat("scatter kernel, ", field), absl::StrCat(value), remedy);
  };
  const std::pair<const char*, double> radii[] = {{"core_radius_deg", core_radius_deg},
                                                  {"tail_radius_deg", tail_radius_deg},
                                                  {"reach_deg", reach_deg}};
  for (const auto& [field, value] : radii) {
    if (!(value > 0 && std::isfinite(value))) return bad(field, value, "give degrees above 0");
  }
  if (core_radius_deg > reach_deg) {
    return bad("core_radius_deg", core_radius_deg, "give a core within the reach");
  }
  const std::pair<const char*, double> shares[] = {{"tail_share", tail_share},
                                                   {"pedestal_share", pedestal_share}};
  for (const auto& [field, value] : shares) {
    if (!(value >= 0 && value < 1)) return bad(field, value, "give a share from 0 to below 1");
  }
  if (!(CoreShare() > 0)) {
    return bad("tail_share + pedestal_share", tail_share + pedestal_share,
               "leave some of the energy to the core");
  }
  if (!(tail_exponent >= kExponentMin && tail_exponent <= kExponentMax)) {
    return bad("tail_exponent", tail_exponent, "give an exponent from 0.1 to 40");
  }
  return absl::OkStatus();
}

ScatterKernel CoreOf(const ScatterKernel& kernel) {
  ScatterKernel core = kernel;
  core.tail_share = 0;
  core.pedestal_share = 0;
  return core;
}

RadialWeight::RadialWeight(const ScatterKernel& kernel) : kernel_(kernel) {
  core_whole_ = CoreSlopes(kernel.reach_deg);
  tail_whole_ = TailSlopes(kernel.reach_deg);
}

double RadialWeight::CoreEnergy(double radius_deg) const {
  const double ratio = radius_deg / kernel_.core_radius_deg;
  if (kernel_.core == CoreShape::kDisk) return ratio < 1 ? ratio * ratio : 1;
  return -std::expm1(-0.5 * ratio * ratio);
}

double RadialWeight::TailMass(double radius_deg) const {
  const double ratio = radius_deg / kernel_.tail_radius_deg;
  const double q = ratio * ratio;
  const double k = 1 - kernel_.tail_exponent / 2;
  if (kernel_.tail == TailShape::kMoffat) return PowerIntegral(k, std::log1p(q));
  return q <= 1 ? q : 1 + PowerIntegral(k, std::log(q));
}

PartEnergy RadialWeight::CoreSlopes(double radius_deg) const {
  const double ratio = radius_deg / kernel_.core_radius_deg;
  const double energy = CoreEnergy(radius_deg);
  if (kernel_.core == CoreShape::kDisk) return {energy, ratio < 1 ? -2 * energy : 0};
  return {energy, -ratio * ratio * std::exp(-0.5 * ratio * ratio)};
}

PartEnergy RadialWeight::TailSlopes(double radius_deg) const {
  const double ratio = radius_deg / kernel_.tail_radius_deg;
  const double q = ratio * ratio;
  const double k = 1 - kernel_.tail_exponent / 2;
  const bool moffat = kernel_.tail == TailShape::kMoffat;
  if (!moffat && q <= 1) return {q, -2 * q};
  const double log_q = moffat ? std::log1p(q) : std::log(q);
  const double density = std::exp((k - 1) * log_q);  // over that on the axis
  return {TailMass(radius_deg), -2 * q * density,
          -kernel_.tail_exponent / 2 * PowerIntegralSlope(k, log_q)};
}

PartEnergy RadialWeight::CoreWithin(double radius_deg) const {
  if (!(radius_deg > 0)) return {};
  if (radius_deg >= kernel_.reach_deg) return {1};
  return Normalised(CoreSlopes(radius_deg), core_whole_);
}

PartEnergy RadialWeight::TailWithin(double radius_deg) const {
  if (!(radius_deg > 0)) return {};
  if (radius_deg >= kernel_.reach_deg) return {1};
  return Normalised(TailSlopes(radius_deg), tail_whole_);
}

double RadialWeight::CoreEndDeg() const {
  const double cores = kernel_.core == CoreShape::kDisk ? 1 : kGaussianEnd;
  return std::fmin(cores * kernel_.core_radius_deg, kernel_.reach_deg);
}

double RadialWeight::EnergyWithin(double radius_deg) const {
  if (!(radius_deg > 0)) return 0;
  if (radius_deg >= kernel_.reach_deg) return 1;
  double energy = kernel_.CoreShare() * CoreEnergy(radius_deg) / core_whole_.energy;
  if (kernel_.tail_share > 0)
    energy += kernel_.tail_share * TailMass(radius_deg) / tail_whole_.energy;
  const double ratio = radius_deg / kernel_.reach_deg;
  return energy + kernel_.pedestal_share * ratio * ratio;
}

double RadialWeight::Density(double radius_deg) const {
  if (radius_deg > kernel_.reach_deg) return 0;
  const double ratio = radius_deg / kernel_.core_radius_deg;
  double core = ratio <= 1 ? 1 : 0;
  if (kernel_.core == CoreShape::kGaussian) core = 0.5 * std::exp(-0.5 * ratio * ratio);
  const double core_area = kernel_.core_radius_deg * kernel_.core_radius_deg * core_whole_.energy;
  double density = kernel_.CoreShare() * core / core_area;
  if (kernel_.tail_share > 0) {
    const double scaled = radius_deg / kernel_.tail_radius_deg;
    const double base =
        kernel_.tail == TailShape::kMoffat ? 1 + scaled * scaled : std::fmax(scaled * scaled, 1.0);
    const double tail_area = kernel_.tail_radius_deg * kernel_.tail_radius_deg * tail_whole_.energy;
    density += kernel_.tail_share * std::pow(base, -kernel_.tail_exponent / 2) / tail_area;
  }
  density += kernel_.pedestal_share / (kernel_.reach_deg * kernel_.reach_deg);
  return density / std::numbers::pi;
}

}  // namespace eyebox::optics
