// The rig that coverage is counted on.
#ifndef EYEBOX_TESTS_TOOLS_COVERAGE_SMALL_RIG_H_
#define EYEBOX_TESTS_TOOLS_COVERAGE_SMALL_RIG_H_

#include <cmath>
#include <cstdint>

#include "capture/base/random.h"
#include "capture/camera/sim/parameters.h"

namespace eyebox {

inline constexpr double kSmallRigDegPerPx = 0.1;

// 96 x 96 pixels of 0.1 deg, 12 bits; a tenth of the light goes into a tail of 0.6 deg.
inline capture::SimParameters SmallRig() {
  capture::SimParameters parameters;
  parameters.sensor.size = {.width_px = 96, .height_px = 96};
  parameters.geometry = {
      .focal_length_px = 572.9578, .principal_x_px = 47.5, .principal_y_px = 47.5};
  parameters.scatter = {.core_sigma_px = 0.6,
                        .tail_weight = 0.1,
                        .tail_scale_px = 6,
                        .tail_beta = 1.5,
                        .tail_radius_px = 80};
  return parameters;
}

// The same through another w: shares of the tail from 0.1 % to 30 %, core and tail as lenses and
// headsets have them, exponents from 2.4 to 4.4.
inline capture::SimParameters SmallRigOfAnyScatter(uint64_t seed) {
  capture::SimParameters parameters = SmallRig();
  RandomStream random({seed, 99});
  parameters.scatter.core_sigma_px = 0.5 + 0.7 * random.Uniform();
  parameters.scatter.tail_weight = 0.001 * std::pow(300.0, random.Uniform());
  parameters.scatter.tail_scale_px = 3 * std::pow(5.0, random.Uniform());
  parameters.scatter.tail_beta = 1.2 + random.Uniform();
  return parameters;
}

// What is left of a rig when its scattered light is taken out: the core is kept.
inline capture::SimParameters WithoutTail(capture::SimParameters parameters) {
  parameters.scatter.tail_weight = 0;
  return parameters;
}

}  // namespace eyebox

#endif  // EYEBOX_TESTS_TOOLS_COVERAGE_SMALL_RIG_H_
