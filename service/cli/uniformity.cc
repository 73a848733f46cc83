#include <cstdio>
#include <optional>
#include <string>

#include "capture/base/status.h"
#include "service/cli/command.h"
#include "service/cli/terminal.h"
#include "service/single_steps.h"

namespace eyebox::service::cli {
namespace {

struct Options {
  std::string recording;
  std::optional<std::string> series;
  std::string sensor;
  std::string out;
  bool json = false;
};

absl::Status Run(const Options& options) {
  EYEBOX_ASSIGN_OR_RETURN(const v1::UniformityResult result,
                          MapUniformity({options.recording, options.series, options.sensor},
                                        options.out, TerminalWatcher()));
  PrintWarnings(result.warnings());
  if (options.json) return PrintJson(result);
  PrintParameters(result.parameters());
  for (const v1::UniformityPoint& point : result.points_9()) {
    std::printf("  g(%.1f px, %.1f px) = %.4f +- %.4f\n", point.x_px(), point.y_px(), point.g(),
                point.sigma());
  }
  return absl::OkStatus();
}

}  // namespace

void AddUniformity(CLI::App& app, Work& work) {
  AddCommand<Options>(
      app, work, "uniformity", "Map the nonuniformity g(x) of the brightest grey full field.",
      "eyebox uniformity recording --out maps --json",
      [](CLI::App& command, Options& options) {
        command.add_option("recording", options.recording, "Folder of the recording")->required();
        command.add_option("--series", options.series, "Series (default: the main or only one)");
        command.add_option("--sensor", options.sensor, kSensorHelp);
        command.add_option("--out", options.out, "Write raw and smooth g with sigma there as NPY");
        command.add_flag("--json", options.json, "Print the result as JSON on stdout");
      },
      Run);
}

}  // namespace eyebox::service::cli
