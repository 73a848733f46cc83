#include <algorithm>
#include <cmath>

#include "fit/activation/activation_problem.h"
#include "fit/activation/fit_activation.h"

namespace eyebox::fit {
namespace {

constexpr double kDetermines = 1 - 1e-6;

// How far the fitted luminance at the drive of reading `at` follows all readings of that drive.
struct Leverage {
  double total = 0;
  int readings = 0;
};

Leverage LeverageAt(const ActivationFit& fit, size_t at) {
  const double drive = fit.levels[at].reading.drive;
  const std::vector<double> gradient = ParameterGradient(fit.model, fit.activation, drive);
  Leverage leverage;
  for (size_t i = 0; i < fit.levels.size(); ++i) {
    if (fit.levels[i].reading.drive != drive) continue;
    ++leverage.readings;
    for (size_t p = 0; p < gradient.size(); ++p) {
      leverage.total += gradient[p] * fit.response[p * fit.levels.size() + i];
    }
  }
  return leverage;
}

}  // namespace

// Without the m readings of a drive the prediction there is (L - H mean) / (1 - H), with H their
// leverage; its variance is sigma^2 H / m / (1 - H).
double LeftOutByScatter(const ActivationFit& fit) {
  if (fit.weighting == Weighting::kUnweighted || fit.degrees_of_freedom <= 0) return 0;
  const auto [least, most] = std::minmax_element(
      fit.levels.begin(), fit.levels.end(),
      [](const auto& a, const auto& b) { return a.reading.drive < b.reading.drive; });
  LevelSeries series;
  for (const FittedLevel& level : fit.levels) series.readings.push_back(level.reading);
  const double floor = RelativeFloor(series);
  const double scatter = std::sqrt(fit.chi_square / fit.degrees_of_freedom);
  double sum = 0;
  int count = 0;
  for (size_t i = 0; i < fit.levels.size(); ++i) {
    const LevelReading& reading = fit.levels[i].reading;
    if (reading.drive == least->reading.drive || reading.drive == most->reading.drive) continue;
    const Leverage leverage = LeverageAt(fit, i);
    if (!(leverage.total < kDetermines)) continue;
    const double sigma = fit.weighting == Weighting::kMeasuredSigma
                             ? reading.luminance_sigma / std::max(reading.luminance, floor)
                             : scatter;
    sum += sigma * sigma * (1 + leverage.total / leverage.readings / (1 - leverage.total));
    ++count;
  }
  return count == 0 ? 0 : std::sqrt(sum / count);
}

}  // namespace eyebox::fit
