#include "fit/scatter/glare_model.h"

#include <algorithm>
#include <cmath>

namespace eyebox::fit {
namespace {

constexpr double kStep = 1e-4;  // of coordinates: errors of differences about 1e-8
constexpr double kLargestLogit = 18;

double Logistic(double x) { return 1 / (1 + std::exp(-x)); }

double Logit(double share) {
  if (!(share > 0)) return -kLargestLogit;
  return std::clamp(std::log(share / (1 - share)), -kLargestLogit, kLargestLogit);
}

}  // namespace

optics::ScatterKernel KernelOf(const GlareValues& values, const ScatterFitOptions& options) {
  return {options.core,        options.tail,          values[kCoreRadius],    values[kTailShare],
          values[kTailRadius], values[kTailExponent], values[kPedestalShare], options.reach_deg};
}

GlareModel::GlareModel(const GlareSeries& series, const ScatterFitOptions& options)
    : series_(series), options_(options), luminance_unit_(series.LargestLuminance() / 100) {
  if (!options_.instrument.has_value()) return;
  const optics::RadialWeight first(options_.instrument->kernel);
  for (const GlareReading& reading : series_.readings) {
    std::vector<double> radii = {reading.diameter_deg / 2, series_.field_radius_deg};
    for (const FieldRing& ring : series_.field) radii.push_back(ring.outer_radius_deg);
    for (const double radius : radii) {
      const DiskKey key{radius, reading.offset_deg};
      if (after_instrument_.contains(key)) continue;
      after_instrument_.emplace(key, optics::SecondScatterer(first, {key.first, key.second}));
    }
  }
}

// Disks of falling brightness, laid over each other: each ring less the next over all within it.
double GlareModel::LightIn(const optics::RadialWeight& weight, const DiskKey& disk) const {
  if (series_.field.empty()) return EnergyIn(weight, disk);
  double light = 0;
  for (size_t k = 0; k < series_.field.size(); ++k) {
    const auto [outer, relative] = series_.field[k];
    if (outer >= disk.first) return light + relative * EnergyIn(weight, disk);
    const double next = k + 1 < series_.field.size() ? series_.field[k + 1].relative : 0;
    if (relative != next) light += (relative - next) * EnergyIn(weight, {outer, disk.second});
  }
  return light;
}

std::vector<int> GlareModel::Free() const {
  const std::array<bool, kGlareParameters> held = {options_.core_radius_deg.has_value(),
                                                   false,
                                                   options_.tail_radius_deg.has_value(),
                                                   options_.tail_exponent.has_value(),
                                                   !options_.pedestal,
                                                   options_.bright_luminance.has_value(),
                                                   options_.background_luminance.has_value()};
  std::vector<int> free;
  for (int i = 0; i < kGlareParameters; ++i) {
    if (!held[i]) free.push_back(i);
  }
  return free;
}

GlareValues GlareModel::ValuesOf(const GlareCoordinates& coordinates) const {
  GlareValues values{};
  for (const int i : {kCoreRadius, kTailRadius, kTailExponent, kBright}) {
    values[i] = std::exp(coordinates[i]);
  }
  values[kTailShare] = Logistic(coordinates[kTailShare]);
  if (options_.pedestal) {
    values[kPedestalShare] = Logistic(coordinates[kPedestalShare]) * (1 - values[kTailShare]);
  }
  values[kBackground] = coordinates[kBackground] * luminance_unit_;
  return values;
}

GlareCoordinates GlareModel::CoordinatesOf(const GlareValues& values) const {
  GlareCoordinates coordinates{};
  for (const int i : {kCoreRadius, kTailRadius, kTailExponent, kBright}) {
    coordinates[i] = std::log(values[i]);
  }
  coordinates[kTailShare] = Logit(values[kTailShare]);
  coordinates[kPedestalShare] = Logit(values[kPedestalShare] / (1 - values[kTailShare]));
  coordinates[kBackground] = values[kBackground] / luminance_unit_;
  return coordinates;
}

std::array<GlareCoordinates, kGlareParameters> GlareModel::ValueDerivatives(
    const GlareCoordinates& coordinates) const {
  std::array<GlareCoordinates, kGlareParameters> derivatives{};
  for (int j = 0; j < kGlareParameters; ++j) {
    GlareCoordinates above = coordinates;
    GlareCoordinates below = coordinates;
    above[j] += kStep;
    below[j] -= kStep;
    const GlareValues high = ValuesOf(above);
    const GlareValues low = ValuesOf(below);
    for (int i = 0; i < kGlareParameters; ++i) {
      derivatives[i][j] = (high[i] - low[i]) / (2 * kStep);
    }
  }
  return derivatives;
}

double GlareModel::EnergyIn(const optics::RadialWeight& weight, const DiskKey& disk) const {
  const auto found = after_instrument_.find(disk);
  if (found != after_instrument_.end()) return found->second.EnergyInDisk(weight);
  return optics::EnergyInDisk(weight, {disk.first, disk.second});
}

std::vector<GlareShares> GlareModel::Shares(const optics::ScatterKernel& kernel) const {
  const optics::RadialWeight weight(kernel);
  std::map<double, double> field_energy;  // by offset
  std::vector<GlareShares> shares;
  shares.reserve(series_.readings.size());
  for (const GlareReading& reading : series_.readings) {
    const auto [field, is_new] = field_energy.try_emplace(reading.offset_deg);
    if (is_new) {
      const double whole =
          series_.field.empty() ? series_.field_radius_deg : series_.field.back().outer_radius_deg;
      field->second = LightIn(weight, {whole, reading.offset_deg});
    }
    const double disk = LightIn(weight, {reading.diameter_deg / 2, reading.offset_deg});
    const double rest = std::max(field->second - disk, 0.0);
    const bool bright = reading.pattern == GlarePattern::kBrightDisk;
    shares.push_back(bright ? GlareShares{disk, rest} : GlareShares{rest, disk});
  }
  return shares;
}

std::vector<double> GlareModel::Predict(const GlareValues& values) const {
  std::vector<double> predicted;
  for (const GlareShares& share : Shares(KernelOf(values, options_))) {
    predicted.push_back(share.bright * values[kBright] + share.background * values[kBackground]);
  }
  return predicted;
}

std::vector<double> GlareModel::Residuals(const GlareCoordinates& coordinates) const {
  std::vector<double> residuals = Predict(ValuesOf(coordinates));
  for (size_t i = 0; i < residuals.size(); ++i) {
    const GlareReading& reading = series_.readings[i];
    residuals[i] = (residuals[i] - reading.luminance) / reading.luminance_sigma;
  }
  return residuals;
}

std::vector<double> GlareModel::Derivative(const GlareCoordinates& coordinates, int index) const {
  GlareCoordinates above = coordinates;
  GlareCoordinates below = coordinates;
  above[index] += kStep;
  below[index] -= kStep;
  std::vector<double> derivative = Residuals(above);
  const std::vector<double> low = Residuals(below);
  for (size_t i = 0; i < low.size(); ++i) {
    derivative[i] = (derivative[i] - low[i]) / (2 * kStep);
  }
  return derivative;
}

}  // namespace eyebox::fit
