#include "service/budget.h"

#include <string_view>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "capture/base/status.h"
#include "fit/budget/check_budget.h"
#include "fit/budget/luminance_budget.h"
#include "service/results/parameter.h"

namespace eyebox::service {
namespace {

template <typename Enum, size_t kCount>
absl::StatusOr<Enum> Named(std::string_view name, const Enum (&all)[kCount],
                           const std::string& where) {
  for (const Enum one : all) {
    if (fit::NameOf(one) == name) return one;
  }
  return BadInput(where,
                  absl::StrCat("\"", std::string(name), "\" is no model or weighting of a fit"),
                  "give what `eyebox fit --json` printed");
}

void DescribePoint(const fit::BudgetPoint& from, v1::BudgetPoint& point) {
  point.set_u(from.x);
  point.set_drive(from.drive);
  point.set_drive_sigma(from.drive_sigma);
  point.set_departure_sigma(from.departure_sigma);
  point.set_luminance(from.luminance);
  point.set_luminance_sigma(from.luminance_sigma);
  for (const fit::TermShare& share : from.terms) {
    v1::BudgetTerm& term = *point.add_terms();
    term.set_name(share.name);
    term.set_drive_share(share.drive);
    term.set_departure_share(share.departure);
    term.set_luminance_share(share.luminance);
  }
}

void DescribeTrials(const fit::CheckedQuantity& from, v1::TrialFigure& figure) {
  figure.set_mean(from.trials.mean);
  figure.set_sigma(from.trials.sigma);
  figure.set_low(from.trials.low);
  figure.set_high(from.trials.high);
  figure.set_low_difference(from.low_difference);
  figure.set_high_difference(from.high_difference);
  figure.set_tolerance(from.tolerance);
  figure.set_agrees(from.agrees);
}

std::string VerdictOf(const fit::BudgetCheck& check) {
  if (!check.stable) return "not stable";
  if (check.validated) return "validated";
  std::string where;
  for (const fit::CheckedPoint& point : check.points) {
    const std::pair<const char*, const fit::CheckedQuantity*> quantities[] = {
        {"drive", &point.drive}, {"departure", &point.departure}, {"luminance", &point.luminance}};
    for (const auto& [name, quantity] : quantities) {
      if (!quantity->agrees) absl::StrAppend(&where, ", ", name, " at u ", point.x);
    }
  }
  return absl::StrCat("not validated: ", where.substr(2));
}

void AddCheck(const fit::BudgetCheck& check, double coverage, v1::BudgetResult& result) {
  result.set_trials(static_cast<int64_t>(check.trials));
  result.set_coverage(coverage);
  result.set_check(VerdictOf(check));
  for (int i = 0; i < result.points_size(); ++i) {
    const fit::CheckedPoint& checked = check.points[i];
    v1::BudgetPoint& point = *result.mutable_points(i);
    if (checked.drive.sigma > 0) DescribeTrials(checked.drive, *point.mutable_drive_trials());
    if (checked.departure.sigma > 0) {
      DescribeTrials(checked.departure, *point.mutable_departure_trials());
    }
    if (checked.luminance.sigma > 0) {
      DescribeTrials(checked.luminance, *point.mutable_luminance_trials());
    }
  }
}

}  // namespace

absl::StatusOr<v1::BudgetResult> MakeBudget(const fit::ActivationFit& fit,
                                            const fit::LevelSeries& series,
                                            const BudgetRequest& request) {
  EYEBOX_ASSIGN_OR_RETURN(const std::vector<fit::BudgetTerm> terms,
                          fit::BudgetTerms(fit, series, request.shares));
  const std::vector<double> u = fit::UsualBudgetPoints();
  EYEBOX_ASSIGN_OR_RETURN(const fit::LuminanceBudget budget,
                          fit::MakeLuminanceBudget(fit, terms, u));
  v1::BudgetResult result;
  AddParameter(*result.mutable_parameters(), "condition_number", budget.condition_number, 0, "1");
  AddParameter(*result.mutable_parameters(), "scale_relative_sigma", series.scale_relative_sigma, 0,
               "1");
  for (const fit::BudgetPoint& point : budget.points) DescribePoint(point, *result.add_points());
  result.set_luminance_unit(series.luminance_unit);
  result.set_source(series.source);
  result.set_check("not checked");
  if (request.trials) {
    EYEBOX_ASSIGN_OR_RETURN(const fit::BudgetCheck check,
                            fit::CheckBudget(fit, terms, budget, *request.trials));
    AddCheck(check, request.trials->coverage, result);
  }
  return result;
}

absl::StatusOr<v1::BudgetResult> BudgetOfResult(const v1::ActivationResult& result,
                                                const std::string& where,
                                                const BudgetRequest& request) {
  using fit::ActivationModel;
  using fit::Weighting;
  constexpr ActivationModel kModels[] = {
      ActivationModel::kPowerOffset, ActivationModel::kGammaWithCutoff, ActivationModel::kSrgbLike,
      ActivationModel::kMonotoneSpline};
  constexpr Weighting kWeightings[] = {Weighting::kMeasuredSigma, Weighting::kRelative,
                                       Weighting::kUnweighted};
  EYEBOX_ASSIGN_OR_RETURN(const ActivationModel model, Named(result.model(), kModels, where));
  EYEBOX_ASSIGN_OR_RETURN(const Weighting weighting, Named(result.weighting(), kWeightings, where));
  fit::LevelSeries series;
  for (const v1::LevelResidual& level : result.levels()) {
    series.readings.push_back({level.drive(), level.luminance(), level.luminance_sigma()});
  }
  series.luminance_unit = result.luminance_unit();
  series.scale_relative_sigma = result.scale_relative_sigma();
  series.source = result.source().empty() ? where : result.source();
  EYEBOX_ASSIGN_OR_RETURN(const fit::ActivationFit again,
                          fit::FitActivation(series, model, weighting));
  return MakeBudget(again, series, request);
}

}  // namespace eyebox::service
