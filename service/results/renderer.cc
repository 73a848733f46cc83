#include "service/results/renderer.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>

#include "absl/strings/str_format.h"
#include "fit/renderer/known_knots.h"
#include "optics/render/log_c.h"
#include "service/results/parameter.h"

namespace eyebox::service {
namespace {

constexpr int kFirstPublished = 3;
// The third knot lies where the table is all but constant; published values start to mean something
// after it.
constexpr int kFirstCompared = 4;

void AddPublished(v1::TableKnot& knot) {
  if (knot.entry() < kFirstPublished) return;
  knot.set_u_published(fit::KnotsFromDeltas()[static_cast<size_t>(knot.entry() - kFirstPublished)]);
  knot.set_analytic_over_published(knot.u_analytic() / knot.u_published() - 1);
}

void AddDistance(v1::KnotsResult& result) {
  double sum = 0;
  double largest = 0;
  int count = 0;
  for (const v1::TableKnot& knot : result.knots()) {
    if (knot.entry() < kFirstCompared || knot.u_published() == 0) continue;
    sum += knot.analytic_over_published();
    largest = std::max(largest, std::abs(knot.analytic_over_published()));
    ++count;
  }
  if (count == 0) return;
  result.set_analytic_over_published_max(largest);
  result.set_analytic_over_published_mean(sum / count);
}

}  // namespace

void DescribeRenderError(const fit::SetError& error, v1::RenderError& message) {
  message.set_set(error.set);
  message.set_values(error.values);
  message.set_median_levels(error.median);
  message.set_mean_levels(error.mean);
  message.mutable_bias_levels()->Add(error.bias.begin(), error.bias.end());
  message.mutable_bias_sigma_levels()->Add(error.bias_sigma.begin(), error.bias_sigma.end());
  message.set_worst_levels(error.worst);
  message.set_worst_row(error.worst_row + 1);
}

void DescribeKnots(const fit::RecoveredKnots& recovered, v1::KnotsResult& result) {
  const int size = static_cast<int>(recovered.knots.size());
  const std::vector<double> analytic = fit::AnalyticKnots(size);
  int found = 0;
  for (const fit::RecoveredKnot& recovered_knot : recovered.knots) {
    v1::TableKnot& knot = *result.add_knots();
    knot.set_entry(recovered_knot.cube);
    knot.set_found(recovered_knot.is_found);
    knot.set_u_at_peak(recovered_knot.u_at_peak);
    knot.set_u_fitted(recovered_knot.u_optimised);
    knot.set_u_fitted_sigma(recovered_knot.sigma);
    knot.set_u_analytic(analytic[static_cast<size_t>(recovered_knot.cube - 1)]);
    knot.set_reason(recovered_knot.why_not);
    if (size == fit::kPublishedSize) AddPublished(knot);
    found += recovered_knot.is_found ? 1 : 0;
  }
  AddDistance(result);
  result.set_entry_of_black((size - 1) * optics::LinearToLogC(0));
  AddParameter(*result.mutable_parameters(), "size", size, 0, "1");
  AddParameter(*result.mutable_parameters(), "knots_found", found, 0, "1");
  AddParameter(*result.mutable_parameters(), "rms_residual", recovered.rms_residual, 0, "1");
}

void DescribeModels(const std::vector<fit::ComparedModel>& models, v1::KnotsResult& result) {
  const fit::ComparedModel* best = nullptr;
  for (const fit::ComparedModel& model : models) {
    v1::RenderHypothesis& hypothesis = *result.add_hypotheses();
    hypothesis.set_name(model.hypothesis.name);
    for (const fit::Parameter& parameter : model.parameters) {
      AddParameter(*hypothesis.mutable_parameters(), parameter.name, parameter.value,
                   parameter.sigma, parameter.unit);
    }
    for (const fit::SetError& error : model.held_out) {
      DescribeRenderError(error, *hypothesis.add_held_out());
    }
    for (const fit::SetError& error : model.in_sample) {
      DescribeRenderError(error, *hypothesis.add_in_sample());
    }
    hypothesis.set_mean_held_out_levels(model.mean_held_out);
    hypothesis.mutable_bias_levels()->Add(model.bias.begin(), model.bias.end());
    // The program's own values were fitted elsewhere, perhaps to these very rows: not in the race.
    if (!model.hypothesis.competes) continue;
    if (best == nullptr || model.mean_held_out < best->mean_held_out) best = &model;
  }
  if (best == nullptr) return;
  result.set_best_hypothesis(best->hypothesis.name);
  for (const fit::Parameter& parameter : best->parameters) {
    AddParameter(*result.mutable_parameters(), parameter.name, parameter.value, parameter.sigma,
                 parameter.unit);
  }
}

}  // namespace eyebox::service
