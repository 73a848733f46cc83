#include "service/simulate.h"

#include "capture/base/clock.h"
#include "capture/base/status.h"
#include "capture/camera/sim/sim_rig.h"
#include "capture/camera/sim/truth.h"
#include "service/results/parameter.h"
#include "service/steps/record_plan.h"

namespace eyebox::service {

absl::StatusOr<v1::SimulateResult> Simulate(const SimulateRequest& request,
                                            const Watcher& watcher) {
  capture::RigConfig config = request.rig;
  config.seed = request.seed.value_or(config.seed);
  EYEBOX_RETURN_IF_ERROR(capture::SimParametersOf(config).status());
  EYEBOX_ASSIGN_OR_RETURN(capture::Rig rig, capture::OpenRig(config, SystemClock()));
  EYEBOX_ASSIGN_OR_RETURN(const CapturePlan plan, capture::MakeGreyPlan(request.plan));
  EYEBOX_ASSIGN_OR_RETURN(const capture::RunReport report,
                          RecordPlan(rig, plan, request.recording, watcher));
  EYEBOX_RETURN_IF_ERROR(capture::WriteSimTruth(request.recording, config));
  v1::SimulateResult result;
  AddParameter(*result.mutable_parameters(), "captures", report.captures, 0, "1");
  AddParameter(*result.mutable_parameters(), "frames", static_cast<double>(report.frames), 0, "1");
  result.set_recording(request.recording.string());
  result.set_truth((request.recording / "truth.json").string());
  if (watcher.progress) watcher.progress({1, "done"});
  return result;
}

}  // namespace eyebox::service
