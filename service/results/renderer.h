// Knots and models of a renderer as result messages.
#ifndef EYEBOX_SERVICE_RESULTS_RENDERER_H_
#define EYEBOX_SERVICE_RESULTS_RENDERER_H_

#include <vector>

#include "eyebox/v1/predict.pb.h"
#include "fit/renderer/compare_models.h"
#include "fit/renderer/delta_sweep.h"

namespace eyebox::service {

void DescribeRenderError(const fit::SetError& error, v1::RenderError& message);

// Knots of a sweep beside the analytic and, for 32 entries, the published ones.
void DescribeKnots(const fit::RecoveredKnots& recovered, v1::KnotsResult& result);

void DescribeModels(const std::vector<fit::ComparedModel>& models, v1::KnotsResult& result);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_RESULTS_RENDERER_H_
