#include <map>
#include <optional>
#include <string>

#include "capture/base/file.h"
#include "capture/base/status.h"
#include "service/budget.h"
#include "service/cli/budget_output.h"
#include "service/cli/colour_output.h"
#include "service/cli/command.h"
#include "service/cli/terminal.h"
#include "service/colour.h"
#include "service/report/report.h"
#include "service/result_json.h"
#include "service/single_steps.h"

namespace eyebox::service::cli {
namespace {

struct Options {
  std::string recording;
  std::string csv;
  std::optional<std::string> series;
  std::string sensor;
  fit::ActivationOptions fit;
  std::string out;
  std::string budget;
  bool budget_trials = false;
  bool all_models = false;
  bool json = false;
};

const std::map<std::string, fit::ActivationModel> kModels = {
    {"gamma_with_cutoff", fit::ActivationModel::kGammaWithCutoff},
    {"monotone_spline", fit::ActivationModel::kMonotoneSpline},
    {"power_offset", fit::ActivationModel::kPowerOffset},
    {"srgb_like", fit::ActivationModel::kSrgbLike}};
const std::map<std::string, fit::Weighting> kWeightings = {
    {"measured_sigma", fit::Weighting::kMeasuredSigma},
    {"relative", fit::Weighting::kRelative},
    {"unweighted", fit::Weighting::kUnweighted}};

absl::Status FitColours(const Options& options) {
  if (options.fit.model || options.fit.weighting || !options.out.empty() || options.series ||
      !options.budget.empty()) {
    return BadInput(options.csv,
                    "it is a series of colours, and --model, --weighting, --series, --out and "
                    "--budget are for grey levels",
                    "leave them out");
  }
  EYEBOX_ASSIGN_OR_RETURN(const v1::ColourResult result, FitColourCsv(options.csv, {}));
  PrintWarnings(result.warnings());
  if (options.json) return PrintJson(result);
  PrintColourFit(result);
  return absl::OkStatus();
}

void PrintComparison(const v1::ActivationResult& result) {
  if (result.comparison().empty()) return;
  std::printf("\n  %-18s %-14s %10s %14s %8s\n", "model", "weighting", "rms", "leave-one-out",
              "AICc");
  for (const v1::ModelFigure& figure : result.comparison()) {
    std::printf("  %-18s %-14s", figure.model().c_str(), figure.weighting().c_str());
    if (!figure.failure().empty()) {
      std::printf(" not fitted: %s\n", figure.failure().c_str());
      continue;
    }
    std::printf(" %8.3f %% %12.3f %% %8.1f\n", 100 * figure.rms_relative(),
                100 * figure.leave_one_out_rms_relative(), figure.aicc());
  }
}

void PrintVerdict(const v1::CommonExponentResult& field) {
  if (!field.has_verdict()) return;
  std::printf("\n  %s\n", field.verdict().reason().c_str());
  for (const v1::RegionExponent& region : field.verdict().regions()) {
    std::printf("  region %d, %d: gamma %.4f +- %.4f, rms %s\n", region.row(), region.column(),
                region.gamma(), region.gamma_sigma(),
                report::Percent(region.rms_relative()).c_str());
  }
}

// Not of the fit's result message: a budget has one of its own.
absl::Status WriteBudget(const Options& options, const v1::ActivationResult& result) {
  BudgetRequest request;
  if (options.budget_trials) request.trials = fit::MonteCarloOptions{.tolerance_share = 0.2};
  const std::string& source = options.csv.empty() ? options.recording : options.csv;
  EYEBOX_ASSIGN_OR_RETURN(const v1::BudgetResult budget, BudgetOfResult(result, source, request));
  EYEBOX_ASSIGN_OR_RETURN(const std::string json, ToJson(budget));
  EYEBOX_RETURN_IF_ERROR(WriteFileAtomically(options.budget, json));
  if (!options.json) PrintBudget(budget);
  return absl::OkStatus();
}

absl::Status Run(const Options& options) {
  if (options.budget_trials && options.budget.empty()) {
    return BadInput("--budget-trials", "it checks a budget, and none was asked for",
                    "add --budget FILE");
  }
  if (!options.csv.empty()) {
    EYEBOX_ASSIGN_OR_RETURN(const bool colours, fit::HoldsColours(options.csv));
    if (colours) return FitColours(options);
  }
  EYEBOX_ASSIGN_OR_RETURN(
      const v1::ActivationResult result,
      options.csv.empty()
          ? FitRecording({options.recording, options.series, options.sensor}, options.fit,
                         options.all_models, options.out, TerminalWatcher())
          : FitCsv(options.csv, options.fit, options.all_models));
  PrintWarnings(result.warnings());
  if (options.json) {
    if (!options.budget.empty()) EYEBOX_RETURN_IF_ERROR(WriteBudget(options, result));
    return PrintJson(result);
  }
  std::printf("  %s, weights %s: rms %s, leave-one-out rms %s\n", result.model().c_str(),
              result.weighting().c_str(), report::Percent(result.rms_relative()).c_str(),
              report::Percent(result.leave_one_out_rms_relative()).c_str());
  PrintParameters(result.parameters());
  std::printf("  condition number %.3g\n", result.condition_number());
  std::printf("  %s\n", result.choice_reason().c_str());
  PrintVerdict(result.field());
  PrintComparison(result);
  if (!options.budget.empty()) return WriteBudget(options, result);
  return absl::OkStatus();
}

}  // namespace

void AddFit(CLI::App& app, Work& work) {
  AddCommand<Options>(
      app, work, "fit", "Fit how luminance answers to the drive value.",
      "eyebox fit --csv series.csv --json > fit.json\n  eyebox fit recording --json > fit.json\n  "
      "eyebox fit --csv series.csv --budget budget.json --budget-trials",
      [](CLI::App& command, Options& options) {
        auto* source = command.add_option_group("source", "Exactly one of");
        source->add_option("recording", options.recording, "Folder of the recording");
        source->add_option(
            "--csv", options.csv,
            "Series with columns m_k,lum[,lum_sigma], or m_r,m_g,m_b,x,y,z for colour");
        source->require_option(1);
        command.add_option("--series", options.series, "Series (default: the main or only one)");
        command.add_option("--sensor", options.sensor, kSensorHelp);
        command
            .add_option(
                "--model", options.fit.model,
                "power_offset, gamma_with_cutoff, srgb_like or monotone_spline (default: the "
                "one that predicts best)")
            ->transform(OneOf(kModels));
        command
            .add_option("--weighting", options.fit.weighting,
                        "measured_sigma, relative or unweighted (default: measured sigmas where "
                        "there are any, else relative)")
            ->transform(OneOf(kWeightings));
        command.add_option("--out", options.out,
                           "Write the field's k, delta and gamma by region there as NPY");
        command.add_option("--budget", options.budget,
                           "Write there, as JSON, the uncertainty of a table's drive values and "
                           "of luminance through it, with its sources by share");
        command.add_flag("--budget-trials", options.budget_trials,
                         "Check the budget by fitting random series (JCGM 101; seconds)");
        command.add_flag("--all-models", options.all_models,
                         "Add a table of every model under every weighting");
        command.add_flag("--json", options.json, "Print the result as JSON on stdout");
      },
      Run);
}

}  // namespace eyebox::service::cli
