#include "service/planner/plan_measurement.h"

#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "capture/base/status.h"
#include "capture/recording/plan_file.h"
#include "fit/field/common_exponent.h"
#include "service/planner/explain_plan.h"
#include "service/planner/recording_measurement.h"
#include "service/planner/scene_need.h"
#include "service/planner/simulated_measurement.h"
#include "service/results/parameter.h"
#include "service/scene/predict_scene.h"

namespace eyebox::service {
namespace {

constexpr double kPercent = 100;
constexpr std::string_view kSimulated = "sim:";

absl::StatusOr<std::unique_ptr<FrameSource>> OpenPilot(const PlanRequest& request) {
  if (!request.pilot.empty()) {
    EYEBOX_ASSIGN_OR_RETURN(auto frames, RecordedFrames::Read(request.pilot));
    return std::make_unique<RecordingMeasurement>(std::move(frames));
  }
  const std::string& uri = request.rig.camera_uri;
  if (!uri.starts_with(kSimulated)) {
    return absl::UnimplementedError(absl::StrCat(
        uri,
        ": a device is not asked by itself; record a pilot (eyebox capture RIG --levels 9 "
        "--repeats 4 --disks 8 --out PILOT) and plan with --pilot PILOT"));
  }
  EYEBOX_ASSIGN_OR_RETURN(const capture::SimParameters parameters,
                          capture::NamedSimParameters(uri.substr(kSimulated.size())));
  return std::make_unique<SimulatedMeasurement>(parameters, request.rig.seed);
}

// What the pilot is to measure, as far as the source can give it.
absl::StatusOr<PilotOptions> PilotFor(const Need& need, const FrameSource& source) {
  PilotOptions options;
  options.primaries = !need.colours.empty();
  options.disks_deg.clear();
  if (need.disk_deg > 0) options.disks_deg = {need.disk_deg};
  const Stock* const limits = source.Limits();
  if (limits == nullptr) return options;
  if (need.disk_deg > 0 && limits->disks_deg.empty()) {
    return Rejected("--pilot", "it has no disk on black, and the scene shows things on black",
                    absl::StrFormat("record it with --disks %g", need.disk_deg));
  }
  options = PilotWithin(limits);
  options.primaries = !need.colours.empty();
  if (need.disk_deg == 0) options.disks_deg.clear();
  return options;
}

// The radius of the circle that the image's corners lie on.
double FieldDeg(const FrameSource& source) {
  const ImageSize size = source.Size();
  const PinholeGeometry& geometry = source.Geometry();
  const double corner_px = 0.5 * std::hypot(size.width_px, size.height_px);
  return std::atan(corner_px / geometry.focal_length_px) * 180 / std::numbers::pi;
}

absl::Status Refuse(const Search& search, const PlanRequest& request) {
  const std::string budget =
      request.budget_s ? absl::StrFormat(" within %.4g s", *request.budget_s) : "";
  std::string offers;
  if (search.cheapest) {
    absl::StrAppendFormat(&offers, "; the tolerance takes %.4g s",
                          search.cheapest->prediction.capture_s);
  }
  if (search.best) {
    absl::StrAppendFormat(&offers, "; the best that is offered%s keeps %.3g %% in %.4g s", budget,
                          kPercent * search.best->prediction.bound_95,
                          search.best->prediction.capture_s);
  }
  return Rejected(request.scene.string(),
                  absl::StrFormat("a tolerance of %.3g %% is not kept%s%s",
                                  kPercent * request.tolerance, budget, offers),
                  "choose one of these, or ask less of the scene");
}

absl::Status WritePlan(const CapturePlan& plan, const PlanRequest& request,
                       v1::MeasurementPlan& result) {
  result.set_captures(static_cast<int>(plan.captures.size()));
  if (request.out.empty()) return absl::OkStatus();
  result.set_plan_file(request.out.string());
  return capture::WritePlanFile(plan, request.out);
}

absl::Status CheckRequest(const PlanRequest& request) {
  if (!(request.tolerance > 0 && request.tolerance < 1)) {
    return BadInput("--tolerance", absl::StrFormat("is %g", request.tolerance),
                    "give a share above 0 and below 1, such as 2%");
  }
  constexpr double kFinest = 10 * fit::kSinglePrecisionLoss;
  if (request.tolerance < kFinest) {
    return BadInput("--tolerance",
                    absl::StrFormat("is %g %%, and single precision may lose a tenth of that",
                                    kPercent * request.tolerance),
                    absl::StrFormat("give %g %% or more", kPercent * kFinest));
  }
  if (request.budget_s && !(*request.budget_s > 0)) {
    return BadInput("--budget", absl::StrFormat("is %g s", *request.budget_s),
                    "give a time above 0");
  }
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<v1::MeasurementPlan> PlanMeasurement(const PlanRequest& request,
                                                    const Watcher& watcher) {
  EYEBOX_RETURN_IF_ERROR(CheckRequest(request));
  EYEBOX_RETURN_IF_ERROR(watcher.Reach(0, "what the scene shows"));
  EYEBOX_ASSIGN_OR_RETURN(const SceneInput scene, ReadScene(request.scene));
  EYEBOX_ASSIGN_OR_RETURN(const v1::ScenePrediction shown, PredictScene({request.scene, {}}));
  EYEBOX_ASSIGN_OR_RETURN(const std::unique_ptr<FrameSource> source, OpenPilot(request));
  const SceneNeed need = NeedOf(scene, shown, FieldDeg(*source));
  EYEBOX_RETURN_IF_ERROR(watcher.Reach(0.1, "pilot"));
  EYEBOX_ASSIGN_OR_RETURN(const PilotOptions options, PilotFor(need.need, *source));
  EYEBOX_ASSIGN_OR_RETURN(Pilot pilot, MeasurePilot(*source, *SystemClock(), options));
  EYEBOX_ASSIGN_OR_RETURN(Predictor predictor,
                          Predictor::Make(std::move(pilot), need.need, request.costs));
  EYEBOX_RETURN_IF_ERROR(watcher.Reach(0.3, "settings"));
  EYEBOX_ASSIGN_OR_RETURN(const Search search,
                          FindCheapest(predictor, request.tolerance, request.budget_s));
  const auto& found = search.cheapest;
  if (!found || (request.budget_s && found->prediction.capture_s > *request.budget_s)) {
    return Refuse(search, request);
  }
  v1::MeasurementPlan result;
  auto& parameters = *result.mutable_parameters();
  AddParameter(parameters, "tolerance", request.tolerance, 0, "1");
  AddParameter(parameters, "predicted_bound_95", found->prediction.bound_95, 0, "1");
  AddParameter(parameters, "predicted_rms", found->prediction.rms, 0, "1");
  AddParameter(parameters, "capture_time", found->prediction.capture_s, 0, "s");
  EYEBOX_RETURN_IF_ERROR(ExplainPlan(predictor, *found, need, request.tolerance, result));
  Describe(found->prediction, *result.mutable_parts());
  result.set_considered(static_cast<int64_t>(search.considered));
  result.set_frames(FrameCount(found->setting));
  AddAll(*result.mutable_warnings(), need.warnings);
  EYEBOX_RETURN_IF_ERROR(
      WritePlan(CapturesOf(found->setting, predictor.pilot(), need.need), request, result));
  return result;
}

}  // namespace eyebox::service
