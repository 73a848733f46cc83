// Why a plan is as it is: each decision with the figures behind it.
#ifndef EYEBOX_SERVICE_PLANNER_EXPLAIN_PLAN_H_
#define EYEBOX_SERVICE_PLANNER_EXPLAIN_PLAN_H_

#include "absl/status/status.h"
#include "eyebox/v1/measurement_plan.pb.h"
#include "service/planner/cheapest.h"
#include "service/planner/scene_need.h"

namespace eyebox::service {

void Describe(const Prediction& prediction, v1::ErrorParts& parts);

// Adds the decisions. Errors: those of Predictor.
absl::Status ExplainPlan(Predictor& predictor, const Planned& planned, const SceneNeed& need,
                         double tolerance, v1::MeasurementPlan& plan);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_PLANNER_EXPLAIN_PLAN_H_
