// The levels, exposures and frames that tell the activation best for the time they take.
#ifndef EYEBOX_SERVICE_PLANNER_DESIGN_LEVELS_H_
#define EYEBOX_SERVICE_PLANNER_DESIGN_LEVELS_H_

#include <vector>

#include "absl/status/statusor.h"
#include "fit/activation/level_design.h"
#include "service/planner/pilot.h"
#include "service/planner/setting.h"

namespace eyebox::service {

struct DesignedLevels {
  std::vector<LevelFrames> levels;  // ascending drive, white among them
  double efficiency = 0;            // of the design before its frames were rounded, see LevelDesign
};

// Frames for about `seconds`, stimuli included. I-optimal for the pilot's activation under its
// noise. Errors: those of OptimalLevels; FailedPrecondition (`seconds` do not suffice for one frame
// of each level).
absl::StatusOr<DesignedLevels> DesignLevels(const Pilot& pilot, const Need& need,
                                            fit::ErrorAtU error, double seconds, const Costs& costs,
                                            int calibration_frames);

// Seconds that `levels` take, stimuli included.
double LevelSeconds(const std::vector<LevelFrames>& levels, const std::vector<double>& exposures_s,
                    const Costs& costs);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_PLANNER_DESIGN_LEVELS_H_
