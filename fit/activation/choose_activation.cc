#include <cmath>
#include <optional>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "capture/base/status.h"
#include "fit/activation/fit_activation.h"

namespace eyebox::fit {
namespace {

// A model with one parameter more must predict better than by this; the second is for series
// without noise, where both errors are roundings.
constexpr double kClearlyWorse = 1.05;
constexpr double kSameError = 1e-9;

constexpr ActivationModel kSimplestFirst[] = {
    ActivationModel::kPowerOffset, ActivationModel::kGammaWithCutoff, ActivationModel::kSrgbLike,
    ActivationModel::kMonotoneSpline};

bool PredictsBetter(const ActivationFit& candidate, const ActivationFit& simpler) {
  return candidate.leave_one_out_rms_relative * kClearlyWorse + kSameError <
         simpler.leave_one_out_rms_relative;
}

std::string ScatterRemark(const ActivationFit& fit) {
  const double alone = LeftOutByScatter(fit);
  if (alone == 0) return "";
  if (fit.weighting == Weighting::kMeasuredSigma) {
    return absl::StrFormat("; the stated sigmas of the readings would alone leave %.3g %%",
                           100 * alone);
  }
  return absl::StrFormat(
      "; its readings scatter by %.3g %% about it, which would alone leave %.3g %%",
      100 * std::sqrt(fit.chi_square / fit.degrees_of_freedom), 100 * alone);
}

std::string Reason(const ActivationChoice& choice, const std::string& failures) {
  std::string reason = absl::StrCat(std::string(NameOf(choice.best.model)), " was taken");
  if (choice.tried.size() > 1) {
    absl::StrAppend(&reason,
                    ": its leave-one-out error is the smallest, or close to it with fewer "
                    "parameters");
  }
  for (const ActivationFit& fit : choice.tried) {
    absl::StrAppendFormat(&reason, "; %s predicts a level left out to %.3g %%, AICc %.1f",
                          std::string(NameOf(fit.model)), 100 * fit.leave_one_out_rms_relative,
                          fit.aicc);
  }
  return reason + failures + ScatterRemark(choice.best);
}

}  // namespace

absl::StatusOr<ActivationChoice> ChooseActivation(const LevelSeries& series,
                                                  const ActivationOptions& options) {
  const Weighting weighting = options.weighting.value_or(
      series.HasSigmas() ? Weighting::kMeasuredSigma : Weighting::kRelative);
  if (options.model) {
    EYEBOX_ASSIGN_OR_RETURN(ActivationFit fit, FitActivation(series, *options.model, weighting));
    const std::string reason = absl::StrCat(std::string(NameOf(fit.model)), " was asked for");
    return ActivationChoice{fit, {fit}, reason};
  }
  ActivationChoice choice;
  std::string failures;
  std::optional<absl::Status> first_failure;
  for (const ActivationModel model : kSimplestFirst) {
    absl::StatusOr<ActivationFit> fit = FitActivation(series, model, weighting);
    if (!fit.ok()) {
      if (!first_failure) first_failure = fit.status();
      absl::StrAppend(&failures, "; ", std::string(NameOf(model)), " was not fitted (",
                      std::string(fit.status().message()), ")");
      continue;
    }
    if (choice.tried.empty() || PredictsBetter(*fit, choice.best)) choice.best = *fit;
    choice.tried.push_back(*std::move(fit));
  }
  if (choice.tried.empty()) return *first_failure;
  choice.reason = Reason(choice, failures);
  return choice;
}

std::vector<ComparedActivation> CompareActivations(const LevelSeries& series) {
  std::vector<Weighting> weightings = {Weighting::kRelative, Weighting::kUnweighted};
  if (series.HasSigmas()) weightings.insert(weightings.begin(), Weighting::kMeasuredSigma);
  std::vector<ComparedActivation> compared;
  for (const Weighting weighting : weightings) {
    for (const ActivationModel model : kSimplestFirst) {
      compared.push_back({model, weighting, FitActivation(series, model, weighting)});
    }
  }
  return compared;
}

}  // namespace eyebox::fit
