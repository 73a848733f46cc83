// `eyebox plan`: reads a scene, decides what must be measured and modelled and what not.
#ifndef EYEBOX_SERVICE_PLANNER_PLAN_MEASUREMENT_H_
#define EYEBOX_SERVICE_PLANNER_PLAN_MEASUREMENT_H_

#include <filesystem>
#include <optional>

#include "absl/status/statusor.h"
#include "capture/base/capture_spec.h"
#include "capture/camera/rig.h"
#include "eyebox/v1/measurement_plan.pb.h"
#include "service/planner/cheapest.h"
#include "service/planner/frame_source.h"
#include "service/watcher.h"

namespace eyebox::service {

struct PlanRequest {
  std::filesystem::path scene;
  double tolerance = 0.02;           // 95 % of relative errors are to lie within it
  std::optional<double> budget_s;    // of captures
  capture::RigConfig rig;            // a simulated one, on which the pilot is measured
  std::filesystem::path pilot = {};  // instead: a recording of the rig, of which it is made
  std::filesystem::path out;         // capture plan (.textproto); empty: none is written
  Costs costs;
};

// Errors: those of ReadScene and PredictScene; Unimplemented (a rig that is not simulated,
// without a recording); those of RecordedFrames::Read;
// FailedPrecondition (tolerance and budget cannot be kept together: names what can); those of
// MeasurePilot.
absl::StatusOr<v1::MeasurementPlan> PlanMeasurement(const PlanRequest& request,
                                                    const Watcher& watcher);

// What to capture for `setting`: darks, flats, the levels of series "" (or "red", "green", "blue"
// and white), what the scene shows (series "scene-1" and on, ascending luminance), the disk. Flats
// are of the luminance that the pilot's were.
CapturePlan CapturesOf(const Setting& setting, const Pilot& pilot, const Need& need);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_PLANNER_PLAN_MEASUREMENT_H_
