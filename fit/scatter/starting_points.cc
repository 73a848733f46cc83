#include <algorithm>
#include <cmath>
#include <utility>

#include "fit/scatter/glare_model.h"

namespace eyebox::fit {
namespace {

constexpr double kTailShares[] = {0.002, 0.03, 0.25};
constexpr double kTailRadii[] = {0.2, 1, 5};
constexpr double kTailExponents[] = {2.3, 4};
constexpr double kCoreOfSmallest[] = {0.1, 0.25, 0.5, 1};  // of the smallest disk's diameter
constexpr double kLeastLuminance = 1e-6;                   // of the largest reading

double SmallestDiameter(const GlareSeries& series) {
  double smallest = series.field_radius_deg;
  for (const GlareReading& reading : series.readings) {
    if (reading.diameter_deg > 0) smallest = std::min(smallest, reading.diameter_deg);
  }
  return smallest;
}

// Weighted least squares of the two luminances for a given kernel, held ones as they are.
void SolveLuminances(const GlareModel& model, GlareValues& values) {
  const ScatterFitOptions& options = model.options();
  double bb = 0, bd = 0, dd = 0, br = 0, dr = 0;
  const std::vector<GlareShares> shares = model.Shares(KernelOf(values, options));
  for (size_t i = 0; i < shares.size(); ++i) {
    const GlareReading& reading = model.series().readings[i];
    const double weight = 1 / (reading.luminance_sigma * reading.luminance_sigma);
    bb += weight * shares[i].bright * shares[i].bright;
    bd += weight * shares[i].bright * shares[i].background;
    dd += weight * shares[i].background * shares[i].background;
    br += weight * shares[i].bright * reading.luminance;
    dr += weight * shares[i].background * reading.luminance;
  }
  const double least = kLeastLuminance * model.series().LargestLuminance();
  const double determinant = bb * dd - bd * bd;
  double bright = bb > 0 ? br / bb : least;
  double background = 0;
  if (determinant > 1e-12 * bb * dd) {
    bright = (br * dd - dr * bd) / determinant;
    background = (dr * bb - br * bd) / determinant;
  }
  values[kBackground] = options.background_luminance.value_or(background);
  if (options.background_luminance.has_value() && bb > 0) {
    bright = (br - values[kBackground] * bd) / bb;
  }
  values[kBright] = options.bright_luminance.value_or(std::max(bright, least));
}

}  // namespace

std::vector<GlareCoordinates> StartingPoints(const GlareModel& model, size_t most) {
  const ScatterFitOptions& options = model.options();
  const double smallest = SmallestDiameter(model.series());
  std::vector<std::pair<double, GlareCoordinates>> ranked;
  for (const double core : kCoreOfSmallest) {
    for (const double share : kTailShares) {
      for (const double radius : kTailRadii) {
        for (const double exponent : kTailExponents) {
          GlareValues values{};
          values[kCoreRadius] =
              options.core_radius_deg.value_or(std::min(core * smallest, 0.5 * options.reach_deg));
          values[kTailShare] = share;
          values[kTailRadius] =
              options.tail_radius_deg.value_or(std::min(radius, 0.5 * options.reach_deg));
          values[kTailExponent] = options.tail_exponent.value_or(exponent);
          values[kPedestalShare] = options.pedestal ? 0.1 * share : 0;
          SolveLuminances(model, values);
          const GlareCoordinates start = model.CoordinatesOf(values);
          double chi_square = 0;
          for (const double residual : model.Residuals(start)) chi_square += residual * residual;
          if (std::isfinite(chi_square)) ranked.emplace_back(chi_square, start);
        }
      }
    }
  }
  std::ranges::stable_sort(ranked, {}, [](const auto& entry) { return entry.first; });
  std::vector<GlareCoordinates> starts;
  for (const auto& [chi_square, start] : ranked) {
    const bool again = std::ranges::find(starts, start) != starts.end();
    if (!again && starts.size() < most) starts.push_back(start);
  }
  return starts;
}

}  // namespace eyebox::fit
