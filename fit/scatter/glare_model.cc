#include "fit/scatter/glare_model.h"

#include <algorithm>
#include <cmath>

namespace eyebox::fit {
namespace {

constexpr double kLargestLogit = 18;

double Logistic(double x) { return 1 / (1 + std::exp(-x)); }

double Logit(double share) {
  if (!(share > 0)) return -kLargestLogit;
  return std::clamp(std::log(share / (1 - share)), -kLargestLogit, kLargestLogit);
}

double LightThrough(const optics::ScatterKernel& kernel, const PartLight& light) {
  return kernel.CoreShare() * light.core.energy + kernel.tail_share * light.tail.energy +
         kernel.pedestal_share * light.pedestal;
}

// Its derivatives by the kernel's parameters, in their own units.
GlareValues LightSlopes(const optics::ScatterKernel& kernel, const PartLight& light) {
  GlareValues slopes{};
  slopes[kCoreRadius] = kernel.CoreShare() * light.core.by_radius / kernel.core_radius_deg;
  slopes[kTailShare] = light.tail.energy - light.core.energy;
  slopes[kTailRadius] = kernel.tail_share * light.tail.by_radius / kernel.tail_radius_deg;
  slopes[kTailExponent] = kernel.tail_share * light.tail.by_exponent / kernel.tail_exponent;
  slopes[kPedestalShare] = light.pedestal - light.core.energy;
  return slopes;
}

}  // namespace

optics::ScatterKernel KernelOf(const GlareValues& values, const ScatterFitOptions& options) {
  return {options.core,        options.tail,          values[kCoreRadius],    values[kTailShare],
          values[kTailRadius], values[kTailExponent], values[kPedestalShare], options.reach_deg};
}

GlareModel::GlareModel(const GlareSeries& series, const ScatterFitOptions& options)
    : series_(series),
      options_(options),
      luminance_unit_(series.LargestLuminance() / 100),
      table_(LightTable::Of(series, options)) {}

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
  const GlareValues values = ValuesOf(coordinates);
  std::array<GlareCoordinates, kGlareParameters> derivatives{};
  for (const int i : {kCoreRadius, kTailRadius, kTailExponent, kBright}) {
    derivatives[i][i] = values[i];
  }
  const double tail = values[kTailShare];
  derivatives[kTailShare][kTailShare] = tail * (1 - tail);
  if (options_.pedestal) {
    const double of_rest = Logistic(coordinates[kPedestalShare]);
    derivatives[kPedestalShare][kPedestalShare] = of_rest * (1 - of_rest) * (1 - tail);
    derivatives[kPedestalShare][kTailShare] = -of_rest * tail * (1 - tail);
  }
  derivatives[kBackground][kBackground] = luminance_unit_;
  return derivatives;
}

std::vector<GlareShares> GlareModel::Shares(const optics::ScatterKernel& kernel) const {
  const std::vector<ReadingLight> light = table_.LightFor(kernel);
  std::vector<GlareShares> shares;
  shares.reserve(light.size());
  for (size_t i = 0; i < light.size(); ++i) {
    const double disk = LightThrough(kernel, light[i].disk);
    const double rest = std::max(LightThrough(kernel, light[i].rest), 0.0);
    const bool bright = series_.readings[i].pattern == GlarePattern::kBrightDisk;
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

GlareEvaluation GlareModel::Evaluate(const GlareCoordinates& coordinates) const {
  const GlareValues values = ValuesOf(coordinates);
  const optics::ScatterKernel kernel = KernelOf(values, options_);
  const auto by_coordinate = ValueDerivatives(coordinates);
  GlareEvaluation result;
  for (const ReadingLight& light : table_.LightFor(kernel)) {
    const GlareReading& reading = series_.readings[result.residuals.size()];
    const bool bright = reading.pattern == GlarePattern::kBrightDisk;
    const double disk_luminance = values[bright ? kBright : kBackground];
    const double rest_luminance = values[bright ? kBackground : kBright];
    const double disk = LightThrough(kernel, light.disk);
    const double rest = LightThrough(kernel, light.rest);
    const GlareValues disk_slopes = LightSlopes(kernel, light.disk);
    const GlareValues rest_slopes = LightSlopes(kernel, light.rest);
    GlareValues by_value{};
    for (int i = 0; i < kKernelParameters; ++i) {
      by_value[i] = disk_luminance * disk_slopes[i] + rest_luminance * rest_slopes[i];
    }
    by_value[kBright] = bright ? disk : rest;
    by_value[kBackground] = bright ? rest : disk;
    const double predicted =
        by_value[kBright] * values[kBright] + by_value[kBackground] * values[kBackground];
    result.residuals.push_back((predicted - reading.luminance) / reading.luminance_sigma);
    for (int j = 0; j < kGlareParameters; ++j) {
      double slope = 0;
      for (int i = 0; i < kGlareParameters; ++i) slope += by_value[i] * by_coordinate[i][j];
      result.jacobian.push_back(slope / reading.luminance_sigma);
    }
  }
  return result;
}

std::vector<double> GlareModel::Residuals(const GlareCoordinates& coordinates) const {
  return Evaluate(coordinates).residuals;
}

}  // namespace eyebox::fit
