#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "capture/base/clock.h"
#include "capture/base/status.h"
#include "capture/plan.h"
#include "capture/recording/plan_file.h"
#include "eyebox/v1/capture.pb.h"
#include "service/cli/asking_presenter.h"
#include "service/cli/command.h"
#include "service/cli/plan_options.h"
#include "service/cli/rig_source.h"
#include "service/cli/terminal.h"
#include "service/results/parameter.h"
#include "service/steps/capture_log.h"
#include "service/steps/record_plan.h"

namespace eyebox::service::cli {
namespace {

constexpr int kReferenceEvery = 4;  // levels

struct Options {
  std::string rig;
  std::string out;
  capture::PlanOptions plan = {.reference_every = kReferenceEvery};
  std::string plan_file;  // instead of `plan`
  std::vector<CLI::Option*> plan_options;
  capture::SettleOptions settle;
  bool manual = false;
  bool resume = false;
  bool json = false;
};

bool AnyGiven(const std::vector<CLI::Option*>& options) {
  return std::ranges::any_of(options, [](const auto* option) { return option->count() > 0; });
}

absl::StatusOr<capture::Rig> OpenRigOf(const Options& options, const Watcher& watcher) {
  EYEBOX_ASSIGN_OR_RETURN(const capture::RigConfig config, RigOf(options.rig));
  EYEBOX_ASSIGN_OR_RETURN(capture::Rig rig, capture::OpenRig(config, SystemClock()));
  if (options.manual || MeasuresWithDevice(rig)) {
    rig.presenter =
        std::make_unique<AskingPresenter>(stdin, std::move(rig.presenter), watcher.cancelled);
  }
  return rig;
}

absl::StatusOr<CapturePlan> PlanOf(const Options& options) {
  if (options.plan_file.empty()) return capture::MakeGreyPlan(options.plan);
  if (AnyGiven(options.plan_options)) {
    return BadInput("--plan", "does not go with options that make a plan", "leave either out");
  }
  return capture::ReadPlanFile(options.plan_file);
}

absl::StatusOr<capture::RunReport> Capture(const Options& options, const Watcher& watcher) {
  EYEBOX_ASSIGN_OR_RETURN(const CapturePlan plan, PlanOf(options));
  EYEBOX_RETURN_IF_ERROR(options.settle.Validate());
  EYEBOX_ASSIGN_OR_RETURN(capture::Rig rig, OpenRigOf(options, watcher));
  if (!options.resume) return RecordPlan(rig, plan, options.out, watcher, options.settle);
  // Without options of the plan the recording knows it.
  const auto asked = AnyGiven(options.plan_options) || !options.plan_file.empty()
                         ? std::optional(plan)
                         : std::nullopt;
  return ResumePlan(rig, asked, options.out, watcher, options.settle);
}

// How to go on, where something is there to go on with.
absl::Status WithWayOn(const absl::Status& status, const Options& options) {
  std::error_code ignored;
  const bool begun =
      std::filesystem::exists(std::filesystem::path(options.out) / "recording.textproto", ignored);
  if (!begun || !(absl::IsCancelled(status) || absl::IsUnavailable(status))) return status;
  return absl::Status(status.code(),
                      absl::StrCat(status.message(), "; go on with: eyebox capture ", options.rig,
                                   " --out ", options.out, " --resume"));
}

v1::CaptureResult Describe(const capture::RunReport& report, const Options& options) {
  v1::CaptureResult result;
  auto& parameters = *result.mutable_parameters();
  AddParameter(parameters, "captures", report.captures, 0, "1");
  AddParameter(parameters, "frames", static_cast<double>(report.frames), 0, "1");
  AddParameter(parameters, "captures_taken_again", report.captures_taken_again, 0, "1");
  AddParameter(parameters, "implausible", report.implausible, 0, "1");
  AddParameter(parameters, "cameras_reopened", report.cameras_reopened, 0, "1");
  result.set_recording(options.out);
  result.set_log(CaptureLogPath(options.out).string());
  result.mutable_warnings()->Add(report.remarks.begin(), report.remarks.end());
  return result;
}

absl::Status Run(const Options& options) {
  const Watcher watcher = TerminalWatcher();
  const auto report = Capture(options, watcher);
  if (!report.ok()) return WithWayOn(report.status(), options);
  if (watcher.progress) watcher.progress({1, "done"});
  const v1::CaptureResult result = Describe(*report, options);
  if (options.json) return PrintJson(result);
  PrintWarnings(result.warnings());
  PrintParameters(result.parameters());
  std::printf("Wrote %s; how each capture went stands in %s\n", result.recording().c_str(),
              result.log().c_str());
  return absl::OkStatus();
}

void Bind(CLI::App& command, Options& options) {
  command.add_option("rig", options.rig, "A rig file (.textproto) or a camera like aravis:ID")
      ->required();
  command.add_option("--out", options.out, "The recording; must not exist without --resume")
      ->required();
  command.add_option("--plan", options.plan_file, "A capture plan, as eyebox plan --out writes it");
  options.plan_options = BindPlan(command, options.plan);
  options.plan_options.push_back(
      command.add_option("--seed", options.plan.seed, "Of the order of levels")
          ->capture_default_str());
  command
      .add_option("--settle-least", options.settle.least_s,
                  "Wait at least so many s after every change of the patch")
      ->capture_default_str();
  command
      .add_option("--settle-longest", options.settle.longest_s,
                  "Wait no longer than so many s for a patch to settle")
      ->capture_default_str();
  command.add_flag("--manual", options.manual,
                   "Ask for every patch, also where a simulated headset would show it by itself");
  command.add_flag("--resume", options.resume,
                   "Go on with a recording that was interrupted, or whose headset slept");
  command.add_flag("--json", options.json, "Print the result as JSON on stdout");
}

}  // namespace

void AddCapture(CLI::App& app, Work& work) {
  AddCommand<Options>(app, work, "capture",
                      "Record darks, flats and grey levels in random order, with a reference patch "
                      "between them.\nCtrl-C stops; --resume goes on.",
                      "eyebox capture rig.textproto --out recording --levels 33\n"
                      "  eyebox capture rig.textproto --out recording --resume",
                      Bind, Run);
}

}  // namespace eyebox::service::cli
