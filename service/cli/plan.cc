#include <algorithm>
#include <cstdio>
#include <string>

#include "capture/base/status.h"
#include "service/cli/command.h"
#include "service/cli/rig_source.h"
#include "service/cli/share.h"
#include "service/cli/terminal.h"
#include "service/planner/plan_measurement.h"

namespace eyebox::service::cli {
namespace {

constexpr double kPercent = 100;

struct Options {
  std::string rig;
  std::string pilot;
  std::string scene;
  std::string tolerance = "2%";
  std::string budget;
  std::string out;
  PlanRequest request;
  bool json = false;
};

void PrintPlan(const v1::MeasurementPlan& plan) {
  for (const v1::PlanDecision& decision : plan.decisions()) {
    std::printf("%-16s %-48s %s%s\n", decision.about().c_str(), decision.choice().c_str(),
                decision.left_out() ? "left out: " : "", decision.reason().c_str());
  }
  std::printf(
      "95 %% of errors within +- %.3g %% (tolerance %.3g %%), %.4g s of captures: %d "
      "captures, %d frames\n",
      kPercent * plan.parameters(1).value(), kPercent * plan.parameters(0).value(),
      plan.parameters(3).value(), plan.captures(), plan.frames());
}

bool ReadsWhatIsShown(const v1::MeasurementPlan& plan) {
  return std::ranges::any_of(plan.decisions(), [](const v1::PlanDecision& decision) {
    return decision.about() == "activation" && decision.left_out();
  });
}

absl::Status Run(const Options& options) {
  PlanRequest request = options.request;
  request.scene = options.scene;
  request.out = options.out;
  request.pilot = options.pilot;
  if (options.pilot.empty()) {
    if (options.rig.empty()) {
      return BadInput("plan", "neither a rig nor --pilot is given",
                      "give sim:rift-s-like, or --pilot RECORDING of your own rig");
    }
    EYEBOX_ASSIGN_OR_RETURN(request.rig, RigOf(options.rig));
  }
  EYEBOX_ASSIGN_OR_RETURN(request.tolerance, ShareOf("--tolerance", options.tolerance));
  if (!options.budget.empty()) {
    EYEBOX_ASSIGN_OR_RETURN(request.budget_s, SecondsOf("--budget", options.budget));
  }
  EYEBOX_ASSIGN_OR_RETURN(const v1::MeasurementPlan plan,
                          PlanMeasurement(request, TerminalWatcher()));
  PrintWarnings(plan.warnings());
  if (options.json) return PrintJson(plan);
  PrintPlan(plan);
  if (!plan.plan_file().empty()) {
    std::printf("Wrote %s; capture it with: eyebox capture RIG --plan %s --out RECORDING\n",
                plan.plan_file().c_str(), plan.plan_file().c_str());
    if (ReadsWhatIsShown(plan)) {
      std::printf(
          "Then read each of what it shows (scene-1, scene-2, ... from dark to bright): "
          "eyebox reduce RECORDING --series scene-1\n");
    }
  }
  return absl::OkStatus();
}

}  // namespace

void AddPlan(CLI::App& app, Work& work) {
  AddCommand<Options>(
      app, work, "plan",
      "The cheapest measurement that keeps a tolerance for a scene, and why each part is needed",
      "eyebox plan --scene room.textproto --tolerance 2% sim:rift-s-like --out plan.textproto\n"
      "  eyebox plan --scene room.textproto --tolerance 2% --pilot recording --out plan.textproto",
      [](CLI::App& command, Options& options) {
        CLI::Option* const rig =
            command.add_option("rig", options.rig, "Rig file, or the URI of a simulated camera");
        CLI::Option* const pilot = command.add_option(
            "--pilot", options.pilot,
            "Instead of a simulated rig: a recording of yours, which tells its prices");
        rig->excludes(pilot);
        command.add_option("--scene", options.scene, "Scene file, as eyebox predict takes it")
            ->required();
        command
            .add_option("--tolerance", options.tolerance,
                        "Of the luminance: 95 % of relative errors are to lie within it")
            ->capture_default_str();
        command.add_option("--budget", options.budget, "Time for captures, such as 120s");
        command.add_option("--out", options.out, "Write the capture plan there (.textproto)");
        command
            .add_option("--stimulus-seconds", options.request.costs.stimulus_s,
                        "Until a new stimulus is shown and steady")
            ->check(CLI::NonNegativeNumber)
            ->capture_default_str();
        command
            .add_option("--frame-seconds", options.request.costs.frame_s,
                        "Of a frame, beside its exposure")
            ->check(CLI::NonNegativeNumber)
            ->capture_default_str();
        command.add_flag("--json", options.json, "Print the result message");
      },
      Run);
}

}  // namespace eyebox::service::cli
