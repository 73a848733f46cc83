#include "service/contrast.h"

#include <string>

#include "capture/base/status.h"
#include "service/cli/command.h"
#include "service/cli/glare_output.h"
#include "service/cli/scatter_options.h"
#include "service/cli/terminal.h"

namespace eyebox::service::cli {
namespace {

struct Options {
  ContrastRequest request;
  bool json = false;
};

absl::Status Run(const Options& options) {
  EYEBOX_ASSIGN_OR_RETURN(const v1::ContrastResult result,
                          MeasureContrast(options.request, TerminalWatcher()));
  PrintWarnings(result.warnings());
  if (options.json) return PrintJson(result);
  PrintGlareFigures(result.figures());
  return absl::OkStatus();
}

}  // namespace

void AddContrast(CLI::App& app, Work& work) {
  AddCommand<Options>(
      app, work, "contrast",
      "Full-field and checkerboard contrast, and glare in black spots, with their floors.",
      "eyebox capture rig.textproto --checkerboards 5,10 --black-disks 5 --out rec --manual\n"
      "  eyebox contrast rec --scatter scatter.json",
      [](CLI::App& command, Options& options) {
        ContrastRequest& request = options.request;
        command.add_option("recording", request.recording, "Folder of the recording")->required();
        command.add_option("--series", request.series, "Series (default: glare)");
        command.add_option("--scatter", request.scatter,
                           "The instrument's scatter: what eyebox scatter --json printed");
        command.add_option("--field-radius-deg", request.glare.field_radius_deg, "Of the display")
            ->capture_default_str();
        AddSurround(command, request.glare.surround);
        command
            .add_option("--spot-radius-px", request.glare.reading.spot_radius_px,
                        "Pixels around the axis that count as a reading")
            ->capture_default_str();
        command.add_flag("--json", options.json, "Print the result as JSON on stdout");
      },
      Run);
}

}  // namespace eyebox::service::cli
