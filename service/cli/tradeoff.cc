#include <cstdio>
#include <filesystem>
#include <string>

#include "capture/base/status.h"
#include "service/cli/command.h"
#include "service/cli/rig_source.h"
#include "service/cli/terminal.h"
#include "service/planner/tradeoff_result.h"

namespace eyebox::service::cli {
namespace {

constexpr double kPercent = 100;

struct Options {
  std::string rig;
  TradeoffRequest request;
  std::string out;
  bool json = false;
};

void PrintLines(const v1::TradeoffResult& result) {
  std::printf("%-16s %-34s %9s %9s %10s %16s %9s %7s %12s\n", "lever", "setting", "capture",
              "compute", "predicted", "measured rms", "95 % in", "within", "price");
  for (const v1::TradeoffLine& line : result.lines()) {
    std::printf("%-16s %-34s %7.2f s %7.3f s %8.3f %% %6.3f +- %4.3f %% %7.3f %% %5.1f %%",
                line.lever().c_str(), line.setting().c_str(), line.capture_s(), line.compute_s(),
                kPercent * line.predicted_rms(), kPercent * line.measured_rms().value(),
                kPercent * line.measured_rms().sigma(), kPercent * line.predicted_bound_95(),
                kPercent * line.share_within_bound());
    if (line.has_price_s_per_percent()) std::printf(" %8.1f s/%%", line.price_s_per_percent());
    std::printf("%s\n", line.on_front() ? "  front" : "");
  }
}

absl::Status Run(const Options& options) {
  TradeoffRequest request = options.request;
  request.out = options.out;
  if (std::filesystem::is_directory(options.rig)) {
    request.recording = options.rig;
  } else {
    EYEBOX_ASSIGN_OR_RETURN(request.rig, RigOf(options.rig));
  }
  EYEBOX_ASSIGN_OR_RETURN(const v1::TradeoffResult result, RunTradeoff(request, TerminalWatcher()));
  PrintWarnings(result.warnings());
  if (options.json) return PrintJson(result);
  PrintLines(result);
  std::printf(
      "Errors are relative, of the luminance that a scene shows; %d trials; predicted and measured "
      "differ by %.1f %% (median)\n",
      result.trials(), kPercent * result.median_disagreement());
  for (const v1::DesignSaving& saving : result.savings()) {
    std::printf(
        "Designed levels: %.2f s leave %.3f %% of departure, for which 17 evenly spaced ones take "
        "%.2f s: "
        "%.1f times as long\n",
        saving.design_s(), kPercent * saving.departure_rms(), saving.even_s(), saving.factor());
  }
  for (const std::string& file : result.files()) {
    std::printf("Wrote %s/%s\n", options.out.c_str(), file.c_str());
  }
  return absl::OkStatus();
}

}  // namespace

void AddTradeoff(CLI::App& app, Work& work) {
  AddCommand<Options>(
      app, work, "tradeoff",
      "Time and error of every lever of a measurement, predicted and measured: on a simulated rig, "
      "or on half of a recording's frames against the other half",
      "eyebox tradeoff sim:rift-s-like --out prices\n  eyebox tradeoff recording --out prices",
      [](CLI::App& command, Options& options) {
        command
            .add_option("rig", options.rig,
                        "Rig file, the URI of a simulated camera, or a recording")
            ->required();
        command.add_option("--out", options.out,
                           "Folder for tradeoff.json, tradeoff.csv and tradeoff.svg");
        command
            .add_option("--trials", options.request.options.trials, "Of each setting, 2 to 1000")
            ->check(CLI::Range(2, 1000))
            ->capture_default_str();
        command
            .add_option("--stimulus-seconds", options.request.options.costs.stimulus_s,
                        "Until a new stimulus is shown and steady")
            ->check(CLI::NonNegativeNumber)
            ->capture_default_str();
        command
            .add_option("--frame-seconds", options.request.options.costs.frame_s,
                        "Of a frame, beside its exposure")
            ->check(CLI::NonNegativeNumber)
            ->capture_default_str();
        command.add_flag("--json", options.json, "Print the result message");
      },
      Run);
}

}  // namespace eyebox::service::cli
