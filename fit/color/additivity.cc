#include "fit/color/additivity.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "absl/strings/str_format.h"

namespace eyebox::fit {
namespace {

Rgb Alone(size_t channel, double drive) {
  Rgb stimulus = {0, 0, 0};
  stimulus[channel] = drive;
  return stimulus;
}

std::optional<AdditivityLevel> LevelAt(const ColourSeries& series, const Xyz& black, double drive,
                                       double floor) {
  const std::optional<Xyz> white = series.MeanAt({drive, drive, drive});
  if (!white) return std::nullopt;
  Xyz sum = black;
  for (size_t k = 0; k < 3; ++k) {
    const std::optional<Xyz> alone = series.MeanAt(Alone(k, drive));
    if (!alone) return std::nullopt;
    sum = Plus(sum, Minus(*alone, black));
  }
  AdditivityLevel level{drive, {}, {}};
  const Xyz largest = series.Largest();
  for (size_t c = 0; c < 3; ++c) {
    level.departure[c] = (*white)[c] > 0 ? sum[c] / (*white)[c] - 1 : 0;
    level.counts[c] = (*white)[c] - black[c] > floor * largest[c];
  }
  return level;
}

void Summarize(size_t c, AdditivityTest& test) {
  double sum = 0;
  double squares = 0;
  int count = 0;
  for (const AdditivityLevel& level : test.levels) {
    if (!level.counts[c]) continue;
    const double departure = level.departure[c];
    sum += departure;
    squares += departure * departure;
    ++count;
    if (std::abs(departure) > std::abs(test.max_departure)) {
      test.max_departure = departure;
      test.at_drive = level.drive;
    }
  }
  if (count < 2) {
    test.tested = false;
    return;
  }
  test.mean_departure[c] = sum / count;
  test.rms_departure[c] = std::sqrt(squares / count);
  const double spread = squares - sum * sum / count;
  test.standard_error[c] = std::sqrt(std::max(spread, 0.0) / (count - 1) / count);
}

}  // namespace

AdditivityTest TestAdditivity(const ColourSeries& series, double tolerance, double floor) {
  AdditivityTest test;
  const std::optional<Xyz> black = series.MeanAt({0, 0, 0});
  if (black) {
    for (double drive : series.LevelsAlone(0)) {
      const auto level = LevelAt(series, *black, drive, floor);
      if (level) test.levels.push_back(*level);
    }
  }
  test.tested = !test.levels.empty();
  for (size_t c = 0; c < 3; ++c) Summarize(c, test);
  if (!test.tested) {
    test.verdict =
        "additivity not tested: measure black, and grey and each channel alone at the same levels";
    return test;
  }
  test.passed = true;
  for (size_t c = 0; c < 3; ++c) {
    const double allowed = std::max(tolerance, 3 * test.standard_error[c]);
    test.passed = test.passed && std::abs(test.mean_departure[c]) <= allowed;
  }
  test.verdict = absl::StrFormat(
      "additivity %s: the sum of the primaries departs from white by %+.1f +- %.1f %% in X, %+.1f "
      "+- %.1f %% in Y, %+.1f +- %.1f %% in Z (mean over levels), by at most %+.1f %% at drive "
      "%.4g",
      test.passed ? "holds" : "fails", 100 * test.mean_departure[0], 100 * test.standard_error[0],
      100 * test.mean_departure[1], 100 * test.standard_error[1], 100 * test.mean_departure[2],
      100 * test.standard_error[2], 100 * test.max_departure, test.at_drive);
  return test;
}

std::array<ConstancyTest, 3> TestConstancy(const ColourSeries& series, double tolerance,
                                           double floor) {
  std::array<ConstancyTest, 3> tests;
  const std::optional<Xyz> black = series.MeanAt({0, 0, 0});
  if (!black) return tests;
  for (size_t k = 0; k < 3; ++k) {
    const std::vector<double> drives = series.LevelsAlone(k);
    if (drives.empty()) continue;
    const Xyz top = Minus(*series.MeanAt(Alone(k, drives.back())), *black);
    double squares = 0;
    int count = 0;
    ConstancyTest& test = tests[k];
    for (double drive : drives) {
      const Xyz light = Minus(*series.MeanAt(Alone(k, drive)), *black);
      const double distance = ChromaticityDistance(light, top);
      const bool counts = light[1] > floor * top[1] && std::isfinite(distance);
      test.levels.push_back({drive, std::isfinite(distance) ? distance : 0, counts});
      if (!counts || drive == drives.back()) continue;
      squares += distance * distance;
      ++count;
      if (distance < test.max_distance) continue;
      test.max_distance = distance;
      test.at_drive = drive;
    }
    test.tested = count > 0;
    test.rms_distance = count > 0 ? std::sqrt(squares / count) : 0;
    test.passed = test.tested && test.rms_distance <= tolerance;
  }
  return tests;
}

}  // namespace eyebox::fit
