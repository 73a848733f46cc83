#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>

#include "capture/base/status.h"
#include "service/cli/command.h"
#include "service/cli/known_options.h"
#include "service/cli/scatter_options.h"
#include "service/cli/terminal.h"
#include "service/single_steps.h"

namespace eyebox::service::cli {
namespace {

struct Options {
  std::string recording;
  std::optional<std::string> series;
  std::string sensor;
  std::optional<double> level;
  BracketOptions bracket;
  ScatterChoice scatter;
  std::filesystem::path scale;
  std::string out;
  bool json = false;
};

void PrintBracket(const v1::ReduceResult& result) {
  for (const v1::ExposureShare& exposure : result.exposures()) {
    std::printf("  exposure %-10g s  %3d frames  %6.2f %% saturated\n", exposure.exposure_s(),
                exposure.frames(), 100 * exposure.saturated_share());
  }
  for (const v1::ExposurePair& pair : result.exposure_pairs()) {
    if (!(pair.sigma() > 0)) {
      std::printf("  %g s to %g s: no signal in common\n", pair.short_exposure_s(),
                  pair.long_exposure_s());
      continue;
    }
    std::printf("  %g s to %g s: signal ratio / time ratio = %.4f +- %.4f over %d pixels\n",
                pair.short_exposure_s(), pair.long_exposure_s(),
                pair.signal_ratio_over_time_ratio(), pair.sigma(), pair.pixels());
  }
  std::printf("  %d valid pixels, %d invalid; saturated in all exposures %.3f %%, hot %.3f %%\n",
              result.valid_pixels(), result.invalid_pixels(), 100 * result.saturated_in_all_share(),
              100 * result.hot_share());
}

absl::Status Run(const Options& options) {
  EYEBOX_ASSIGN_OR_RETURN(const v1::ReduceResult result,
                          ReduceSeries({.recording = options.recording,
                                        .series = options.series,
                                        .sensor = options.sensor,
                                        .scatter = options.scatter,
                                        .bracket = options.bracket,
                                        .scale = options.scale},
                                       options.level, options.out, TerminalWatcher()));
  PrintWarnings(result.warnings());
  if (options.json) return PrintJson(result);
  PrintParameters(result.parameters());
  PrintBracket(result);
  return absl::OkStatus();
}

}  // namespace

void AddReduce(CLI::App& app, Work& work) {
  AddCommand<Options>(
      app, work, "reduce", "Merge the exposures of one stimulus into luminance with uncertainty.",
      "eyebox reduce recording --series filter_550nm --out maps --json",
      [](CLI::App& command, Options& options) {
        command.add_option("recording", options.recording, "Folder of the recording")->required();
        command.add_option("--series", options.series, "Series (default: the main or only one)");
        command.add_option("--sensor", options.sensor, kSensorHelp);
        command.add_option("--level", options.level,
                           "Grey drive value, 0 to 1 (default: the first that was recorded)");
        command
            .add_option("--clip", options.bracket.clip_sigmas,
                        "Leave out frames this many sigmas off, 3 or more (default: none)")
            ->check(CLI::Range(3.0, 100.0));
        command.add_flag("--repair", options.bracket.repair_defects,
                         "Fill defective pixels from neighbours for display; they stay masked");
        AddScatterChoice(command, options.scatter);
        AddScale(command, options.scale);
        command.add_option("--out", options.out, "Write luminance, sigma and mask there as NPY");
        command.add_flag("--json", options.json, "Print the result as JSON on stdout");
      },
      Run);
}

}  // namespace eyebox::service::cli
