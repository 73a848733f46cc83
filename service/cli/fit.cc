#include <map>
#include <optional>
#include <string>

#include "capture/base/status.h"
#include "service/cli/colour_output.h"
#include "service/cli/command.h"
#include "service/cli/terminal.h"
#include "service/colour.h"
#include "service/report/report.h"
#include "service/single_steps.h"

namespace eyebox::service::cli {
namespace {

struct Options {
  std::string recording;
  std::string csv;
  std::optional<std::string> series;
  fit::ActivationOptions fit;
  std::string out;
  bool json = false;
};

const std::map<std::string, fit::ActivationModel> kModels = {
    {"gamma_with_cutoff", fit::ActivationModel::kGammaWithCutoff},
    {"power_offset", fit::ActivationModel::kPowerOffset}};
const std::map<std::string, fit::Weighting> kWeightings = {
    {"measured_sigma", fit::Weighting::kMeasuredSigma},
    {"relative", fit::Weighting::kRelative},
    {"unweighted", fit::Weighting::kUnweighted}};

absl::Status FitColours(const Options& options) {
  if (options.fit.model || options.fit.weighting || !options.out.empty() || options.series) {
    return BadInput(options.csv,
                    "it is a series of colours, and --model, --weighting, --series and --out are "
                    "for grey levels",
                    "leave them out");
  }
  EYEBOX_ASSIGN_OR_RETURN(const v1::ColourResult result, FitColourCsv(options.csv, {}));
  PrintWarnings(result.warnings());
  if (options.json) return PrintJson(result);
  PrintColourFit(result);
  return absl::OkStatus();
}

absl::Status Run(const Options& options) {
  if (!options.csv.empty()) {
    EYEBOX_ASSIGN_OR_RETURN(const bool colours, fit::HoldsColours(options.csv));
    if (colours) return FitColours(options);
  }
  EYEBOX_ASSIGN_OR_RETURN(const v1::ActivationResult result,
                          options.csv.empty()
                              ? FitRecording({options.recording, options.series}, options.fit,
                                             options.out, TerminalWatcher())
                              : FitCsv(options.csv, options.fit));
  PrintWarnings(result.warnings());
  if (options.json) return PrintJson(result);
  std::printf("  %s, weights %s: rms %s, leave-one-out rms %s\n", result.model().c_str(),
              result.weighting().c_str(), report::Percent(result.rms_relative()).c_str(),
              report::Percent(result.leave_one_out_rms_relative()).c_str());
  PrintParameters(result.parameters());
  return absl::OkStatus();
}

}  // namespace

void AddFit(CLI::App& app, Work& work) {
  AddCommand<Options>(
      app, work, "fit", "Fit how luminance answers to the drive value.",
      "eyebox fit --csv series.csv --json > fit.json\n  eyebox fit recording --json > fit.json",
      [](CLI::App& command, Options& options) {
        auto* source = command.add_option_group("source", "Exactly one of");
        source->add_option("recording", options.recording, "Folder of the recording");
        source->add_option(
            "--csv", options.csv,
            "Series with columns m_k,lum[,lum_sigma], or m_r,m_g,m_b,x,y,z for colour");
        source->require_option(1);
        command.add_option("--series", options.series, "Series (default: the main or only one)");
        command
            .add_option("--model", options.fit.model,
                        "gamma_with_cutoff or power_offset (default: the better one)")
            ->transform(CLI::CheckedTransformer(kModels));
        command
            .add_option("--weighting", options.fit.weighting,
                        "measured_sigma, relative or unweighted (default: measured sigmas where "
                        "there are any, else relative)")
            ->transform(CLI::CheckedTransformer(kWeightings));
        command.add_option("--out", options.out, "Write the field's k and delta there as NPY");
        command.add_flag("--json", options.json, "Print the result as JSON on stdout");
      },
      Run);
}

}  // namespace eyebox::service::cli
