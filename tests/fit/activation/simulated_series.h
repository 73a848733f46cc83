// Series of levels with a known activation.
#ifndef EYEBOX_TESTS_FIT_ACTIVATION_SIMULATED_SERIES_H_
#define EYEBOX_TESTS_FIT_ACTIVATION_SIMULATED_SERIES_H_

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "capture/base/random.h"
#include "fit/activation/level_series.h"
#include "fit/base/activation.h"

namespace eyebox::fit {

inline double Gaussian(RandomStream& random) {
  const double radius = std::sqrt(-2 * std::log(random.Uniform()));
  return radius * std::cos(6.283185307179586 * random.Uniform());
}

// Levels 0, 1 / (count - 1), ..., 1 with noise of a share of the luminance; sigmas stated.
inline LevelSeries SimulateSeries(const Activation& truth, int count, double relative_sigma,
                                  uint64_t seed = 1) {
  RandomStream random({seed});
  LevelSeries series{{}, "cd/m2", 0, "simulated"};
  for (int i = 0; i < count; ++i) {
    const double drive = static_cast<double>(i) / (count - 1);
    const double luminance = truth.Luminance(drive);
    const double sigma = relative_sigma * luminance;
    series.readings.push_back({drive, std::max(luminance + sigma * Gaussian(random), 0.0), sigma});
  }
  return series;
}

}  // namespace eyebox::fit

#endif  // EYEBOX_TESTS_FIT_ACTIVATION_SIMULATED_SERIES_H_
