// A rig that is quick to simulate.
#ifndef EYEBOX_TESTS_SERVICE_PLANNER_SMALL_RIG_H_
#define EYEBOX_TESTS_SERVICE_PLANNER_SMALL_RIG_H_

#include <gtest/gtest.h>

#include "capture/base/clock.h"
#include "service/planner/pilot.h"
#include "service/planner/simulated_measurement.h"

namespace eyebox::service {

// 64 x 48 pixels over 40 deg.
inline capture::SimParameters SmallRig() {
  capture::SimParameters rig;
  rig.sensor.size = {.width_px = 64, .height_px = 48};
  rig.geometry = {.focal_length_px = 87.9, .principal_x_px = 31.5, .principal_y_px = 23.5};
  rig.scatter.tail_scale_px = 8;
  rig.scatter.tail_radius_px = 32;
  return rig;
}

inline Pilot SmallPilot(const PilotOptions& options = {}) {
  SimulatedMeasurement source(SmallRig(), 1);
  const ManualClock clock;
  const auto pilot = MeasurePilot(source, clock, options);
  EXPECT_TRUE(pilot.ok()) << pilot.status();
  return *pilot;
}

}  // namespace eyebox::service

#endif  // EYEBOX_TESTS_SERVICE_PLANNER_SMALL_RIG_H_
