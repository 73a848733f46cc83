// The rig that coverage is counted on.
#ifndef EYEBOX_TESTS_TOOLS_COVERAGE_SMALL_RIG_H_
#define EYEBOX_TESTS_TOOLS_COVERAGE_SMALL_RIG_H_

#include "capture/camera/sim/parameters.h"

namespace eyebox {

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

}  // namespace eyebox

#endif  // EYEBOX_TESTS_TOOLS_COVERAGE_SMALL_RIG_H_
