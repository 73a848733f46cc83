#include <algorithm>
#include <optional>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "capture/base/status.h"
#include "fit/color/fit_colour.h"

namespace eyebox::fit {
namespace {

// A model with more parameters must predict better than by this; the second is for series without
// noise, where both errors are roundings.
constexpr double kClearlyWorse = 1.05;
constexpr double kSameError = 1e-7;

bool PredictsBetter(const ColourFit& candidate, const ColourFit& simpler) {
  return candidate.LeftOutError() * kClearlyWorse + kSameError < simpler.LeftOutError();
}

std::string Reason(const ColourChoice& choice, const ColourOptions& options,
                   const std::string& failures) {
  std::string reason = absl::StrCat(std::string(NameOf(choice.best.model.kind)),
                                    options.model ? " was asked for" : " was taken");
  if (choice.tried.size() > 1) {
    absl::StrAppend(&reason,
                    ": its leave-one-out error is the smallest, or close to it with fewer "
                    "parameters");
  }
  for (const ColourFit& fit : choice.tried) {
    const Xyz& error = fit.leave_one_out_rms_relative;
    absl::StrAppendFormat(
        &reason, "; %s (%d parameters) predicts a stimulus left out to %.3g, %.3g, %.3g %%",
        std::string(NameOf(fit.model.kind)), ParameterCount(fit.model.kind), 100 * error[0],
        100 * error[1], 100 * error[2]);
  }
  return reason + failures;
}

// What stands against promising colour; empty if nothing does.
std::string Objections(const ColourChoice& choice, const ColourOptions& options) {
  constexpr std::array<const char*, 3> kComponents = {"X", "Y", "Z"};
  std::string objections;
  for (size_t c = 0; c < 3; ++c) {
    const double error = choice.best.leave_one_out_rms_relative[c];
    if (error <= options.largest_left_out_error[c]) continue;
    absl::StrAppendFormat(&objections,
                          "; %s of a stimulus left out is predicted to %.3g %% rms only",
                          kComponents[c], 100 * error);
  }
  for (size_t k = 0; k < 3; ++k) {
    const ConstancyTest& test = choice.constancy[k];
    const std::string channel(kChannelNames[k]);
    if (!test.tested) {
      absl::StrAppend(&objections, "; the constancy of ", channel, " was not tested");
    } else if (!test.passed) {
      absl::StrAppendFormat(&objections,
                            "; %s changes its chromaticity by %.3g u'v' rms, %.3g at drive %.4g",
                            channel, test.rms_distance, test.max_distance, test.at_drive);
    }
  }
  if (!choice.additivity.tested) {
    absl::StrAppend(&objections, "; ", choice.additivity.verdict);
  } else if (!choice.additivity.passed && choice.best.model.kind == ColourModelKind::kAdditive) {
    absl::StrAppend(&objections, "; ", choice.additivity.verdict,
                    ", and no interaction model that was tried repairs it");
  }
  return objections;
}

bool IsMixture(const Rgb& drive) {
  const auto off = std::ranges::count(drive, 0.0);
  const bool grey = drive[0] == drive[1] && drive[1] == drive[2];
  return off < 2 && !grey;
}

void Judge(const ColourOptions& options, ColourChoice& choice) {
  const std::string objections = Objections(choice, options);
  choice.certified = objections.empty();
  if (!choice.certified) {
    choice.verdict = "colour not certified" + objections;
  } else if (choice.best.model.kind == ColourModelKind::kAdditive) {
    choice.verdict = absl::StrCat("colour certified: ", choice.additivity.verdict);
  } else {
    choice.verdict =
        absl::StrCat("colour certified with the ", std::string(NameOf(choice.best.model.kind)),
                     " model: it predicts stimuli left out although ", choice.additivity.verdict);
    if (choice.additivity.passed) {
      choice.verdict =
          absl::StrCat("colour certified with the ", std::string(NameOf(choice.best.model.kind)),
                       " model; ", choice.additivity.verdict);
    }
  }
}

}  // namespace

absl::Status ColourOptions::Validate() const {
  if (!(floor > 0 && floor < 1)) {
    return BadInput("floor", absl::StrCat(floor, " is no share of the largest reading"),
                    "give one between 0 and 1");
  }
  for (double error : largest_left_out_error) {
    if (error > 0) continue;
    return BadInput("largest_left_out_error", absl::StrCat(error, " is not above 0"),
                    "give a relative error");
  }
  if (!(additivity_tolerance > 0 && constancy_tolerance > 0)) {
    return BadInput("additivity_tolerance, constancy_tolerance", "one of them is not above 0",
                    "give positive tolerances");
  }
  return absl::OkStatus();
}

absl::StatusOr<ColourChoice> ChooseColour(const ColourSeries& series,
                                          const ColourOptions& options) {
  EYEBOX_RETURN_IF_ERROR(options.Validate());
  EYEBOX_RETURN_IF_ERROR(series.Validate());
  ColourChoice choice;
  choice.additivity = TestAdditivity(series, options.additivity_tolerance, options.floor);
  choice.constancy = TestConstancy(series, options.constancy_tolerance);
  std::string failures;
  std::optional<absl::Status> first_failure;
  for (const ColourModelKind kind : AllColourModelKinds()) {
    if (options.model && *options.model != kind) continue;
    absl::StatusOr<ColourFit> fit = FitColour(series, kind, options.floor);
    if (!fit.ok()) {
      if (!first_failure) first_failure = fit.status();
      absl::StrAppend(&failures, "; ", std::string(NameOf(kind)), " was not fitted (",
                      std::string(fit.status().message()), ")");
      continue;
    }
    if (choice.tried.empty() || PredictsBetter(*fit, choice.best)) choice.best = *fit;
    choice.tried.push_back(*std::move(fit));
  }
  if (choice.tried.empty()) return *first_failure;
  choice.mixtures_measured = std::ranges::any_of(
      series.readings, [](const ColourReading& reading) { return IsMixture(reading.drive); });
  choice.reason = Reason(choice, options, failures);
  Judge(options, choice);
  return choice;
}

}  // namespace eyebox::fit
