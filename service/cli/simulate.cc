#include <cstdio>
#include <string>

#include "capture/base/status.h"
#include "service/cli/command.h"
#include "service/cli/plan_options.h"
#include "service/cli/rig_source.h"
#include "service/cli/terminal.h"
#include "service/simulate.h"

namespace eyebox::service::cli {
namespace {

struct Options {
  std::string rig;
  std::string out;
  SimulateRequest request;
  bool json = false;
};

absl::Status Run(const Options& options) {
  SimulateRequest request = options.request;
  EYEBOX_ASSIGN_OR_RETURN(request.rig, RigOf(options.rig));
  request.recording = options.out;
  EYEBOX_ASSIGN_OR_RETURN(const v1::SimulateResult result, Simulate(request, TerminalWatcher()));
  if (options.json) return PrintJson(result);
  PrintParameters(result.parameters());
  std::printf("Wrote %s, with the truth in %s\n", result.recording().c_str(),
              result.truth().c_str());
  return absl::OkStatus();
}

}  // namespace

void AddSimulate(CLI::App& app, Work& work) {
  AddCommand<Options>(
      app, work, "simulate", "Record a simulated headset, with the truth beside the frames.",
      "eyebox simulate sim:rift-s-like --out recording --seed 7 --levels 17",
      [](CLI::App& command, Options& options) {
        command.add_option("rig", options.rig, "sim:NAME, or a rig file (.textproto)")->required();
        command.add_option("--out", options.out, "The recording; must not exist")->required();
        command.add_option("--seed", options.request.seed,
                           "Of everything random (default: the rig's, else 1)");
        BindPlan(command, options.request.plan);
        command.add_flag("--json", options.json, "Print the result as JSON on stdout");
      },
      Run);
}

}  // namespace eyebox::service::cli
