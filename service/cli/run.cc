#include <filesystem>
#include <string>

#include "capture/base/status.h"
#include "service/cli/command.h"
#include "service/cli/known_options.h"
#include "service/cli/rig_source.h"
#include "service/cli/run_output.h"
#include "service/cli/scatter_options.h"
#include "service/cli/terminal.h"
#include "service/pipeline.h"

namespace eyebox::service::cli {
namespace {

struct Options {
  std::string source;
  std::string recording;
  RunOutput output;
};

absl::Status Run(const Options& options) {
  const std::filesystem::path source = options.source;
  if (std::filesystem::is_directory(source)) {
    const auto out = options.output.FolderOr(source / "results" / "run");
    return options.output.Print(RunRecording(source, out, options.output.run, TerminalWatcher()),
                                out);
  }
  EYEBOX_ASSIGN_OR_RETURN(const capture::RigConfig rig, RigOf(options.source));
  const auto out = options.output.FolderOr(std::filesystem::path("out") / rig.name);
  const std::filesystem::path recording =
      options.recording.empty() ? out / "recording" : std::filesystem::path(options.recording);
  return options.output.Print(RunRig(rig, recording, out, options.output.run, TerminalWatcher()),
                              out);
}

}  // namespace

void AddRun(CLI::App& app, Work& work) {
  AddCommand<Options>(
      app, work, "run", "Do all of it: reduce, map, fit, design tables and certify them.",
      "eyebox run recording --out result\n  eyebox run sim:rift-s-like --out result --json",
      [](CLI::App& command, Options& options) {
        command
            .add_option("source", options.source,
                        "Folder of a recording, or a rig to capture with first: a .textproto file "
                        "or sim:NAME")
            ->required();
        AddScatterChoice(command, options.output.run.scatter);
        AddScale(command, options.output.run.scale);
        AddGeometryChoice(command, options.output.run.geometry);
        options.output.AddTo(command, "SOURCE/results/run; of a rig: out/NAME");
        command.add_option("--recording", options.recording,
                           "Where a rig's frames go; must not exist (default: OUT/recording)");
        command.add_option("--sensor", options.output.run.sensor, kSensorHelp);
        command.add_option("--preflight", options.output.run.preflight,
                           "preflight.json of the rig, or its folder: certifies what passed");
      },
      Run);
}

}  // namespace eyebox::service::cli
