#include "optics/sensor/emva1288/dark_current.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

namespace eyebox::optics {
namespace {

using Darks = std::span<const SetStatistics* const>;

constexpr size_t kFewestExposures = 3;
constexpr double kLeastSpanKelvin = 2;

bool HasEnoughExposures(Darks darks) {
  std::set<double> exposures;
  for (const SetStatistics* dark : darks) exposures.insert(dark->condition.exposure_s);
  return exposures.size() >= kFewestExposures;
}

std::optional<OffsetLine> VarianceLineOf(Darks darks) {
  std::vector<LinePoint> points;
  for (const SetStatistics* dark : darks) {
    points.push_back({dark->condition.exposure_s, dark->temporal_variance_dn2,
                      dark->temporal_variance_sigma_dn2});
  }
  return FitOffsetLine(points);
}

Quantity InElectrons(const Quantity& dn, const Quantity& gain, int power) {
  const double value = dn.value / std::pow(gain.value, power);
  return {value, std::hypot(dn.sigma / std::pow(gain.value, power),
                            power * value * gain.sigma / gain.value)};
}

struct Temperatures {
  double mean = 0;
  double span = 0;
};

// Empty unless every dark has one.
std::optional<Temperatures> TemperaturesOf(Darks darks) {
  double sum = 0;
  double lowest = INFINITY;
  double highest = -INFINITY;
  for (const SetStatistics* dark : darks) {
    if (!dark->condition.temperature_degC) return std::nullopt;
    const double t = *dark->condition.temperature_degC;
    sum += t;
    lowest = std::min(lowest, t);
    highest = std::max(highest, t);
  }
  return Temperatures{sum / static_cast<double>(darks.size()), highest - lowest};
}

// mean = bias + t mu + t dT slope. Empty where the darks do not tell the three apart.
struct ThermalFit {
  Quantity rate_dn_s;
  Quantity rate_slope_dn_s_K;
};

std::optional<ThermalFit> FitThermal(Darks darks, double mean_deg_c) {
  const auto count = static_cast<Eigen::Index>(darks.size());
  if (count < 4) return std::nullopt;
  Eigen::MatrixXd design(count, 3);
  Eigen::VectorXd mean_dn(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const SetStatistics& dark = *darks[i];
    const double t = dark.condition.exposure_s;
    design.row(i) << 1, t, t * (*dark.condition.temperature_degC - mean_deg_c);
    mean_dn[i] = dark.mean_dn;
  }
  const Eigen::VectorXd scale = design.colwise().norm();
  if (!(scale.minCoeff() > 0)) return std::nullopt;
  const Eigen::MatrixXd scaled = design * scale.cwiseInverse().asDiagonal();
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(scaled);
  qr.setThreshold(1e-6);
  if (qr.rank() < 3) return std::nullopt;
  const Eigen::VectorXd solution = qr.solve(mean_dn);
  double noise = (mean_dn - scaled * solution).squaredNorm() / static_cast<double>(count - 3);
  for (const SetStatistics* dark : darks) {
    noise = std::max(noise, dark->mean_sigma_dn * dark->mean_sigma_dn);
  }
  const Eigen::MatrixXd covariance = noise * (scaled.transpose() * scaled).inverse();
  const auto quantity = [&](Eigen::Index k) {
    return Quantity{solution[k] / scale[k], std::sqrt(covariance(k, k)) / scale[k]};
  };
  return ThermalFit{quantity(1), quantity(2)};
}

}  // namespace

std::optional<Quantity> DarkVarianceAtZero(Darks darks) {
  if (!HasEnoughExposures(darks)) return std::nullopt;
  const auto line = VarianceLineOf(darks);
  return line ? std::optional(line->offset) : std::nullopt;
}

std::optional<DarkCurrent> MeasureDarkCurrent(Darks darks, const Quantity& gain_dn_per_e) {
  if (!HasEnoughExposures(darks)) return std::nullopt;
  std::vector<LinePoint> means;
  for (const SetStatistics* dark : darks) {
    means.push_back({dark->condition.exposure_s, dark->mean_dn, dark->mean_sigma_dn});
  }
  const auto mean_line = FitOffsetLine(means);
  if (!mean_line) return std::nullopt;
  DarkCurrent current;
  current.from_mean_e_s = InElectrons(mean_line->slope, gain_dn_per_e, 1);
  const auto variance_line = VarianceLineOf(darks);
  if (variance_line && variance_line->slope.value > 0) {
    current.from_variance_e_s = InElectrons(variance_line->slope, gain_dn_per_e, 2);
  }
  const auto temperatures = TemperaturesOf(darks);
  if (!temperatures) return current;
  current.temperature_degC = temperatures->mean;
  if (temperatures->span < kLeastSpanKelvin) return current;
  if (const auto thermal = FitThermal(darks, temperatures->mean)) {
    current.from_mean_e_s = InElectrons(thermal->rate_dn_s, gain_dn_per_e, 1);
    current.per_kelvin_e_s_K = InElectrons(thermal->rate_slope_dn_s_K, gain_dn_per_e, 1);
  }
  return current;
}

}  // namespace eyebox::optics
