#include "service/preflight/preflight.h"

#include <cstdio>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "capture/base/clock.h"
#include "capture/base/status.h"
#include "capture/plan.h"
#include "service/cli/asking_presenter.h"
#include "service/cli/command.h"
#include "service/cli/rig_source.h"
#include "service/cli/terminal.h"
#include "service/preflight/certification.h"
#include "service/preflight/describe.h"

namespace eyebox::service::cli {
namespace {

struct Options {
  std::string rig;
  std::string photodiode;
  std::string out;
  uint64_t seed = 0;
  PreflightOptions preflight = {.exposures_s = capture::PlanOptions().exposures_s};
  bool json = false;
};

std::string Text(const v1::Parameter& measured) {
  std::string text = absl::StrFormat("%.6g", measured.value());
  if (measured.sigma() > 0) absl::StrAppendFormat(&text, " +- %.2g", measured.sigma());
  if (measured.unit() != "1") absl::StrAppend(&text, " ", measured.unit());
  return text;
}

const char* Text(v1::CheckVerdict verdict) {
  if (verdict == v1::CHECK_VERDICT_PASSED) return "passed";
  return verdict == v1::CHECK_VERDICT_FAILED ? "FAILED" : "skipped";
}

void PrintTable(const v1::PreflightResult& result) {
  constexpr char kRow[] = "%-16s  %-24s  %-8s  %s\n";
  std::printf(kRow, "check", "measured", "verdict", "wanted");
  for (const v1::PreflightCheck& check : result.checks()) {
    std::printf(kRow, check.name().c_str(),
                check.has_measured() ? Text(check.measured()).c_str() : "-", Text(check.verdict()),
                check.wanted().c_str());
  }
  for (const v1::PreflightCheck& check : result.checks()) {
    if (check.verdict() == v1::CHECK_VERDICT_PASSED) continue;
    std::printf("\n%s %s\n  cause:  %s\n  remedy: %s\n", check.name().c_str(),
                Text(check.verdict()), check.cause().c_str(), check.remedy().c_str());
  }
}

// The exit status tells of a check that failed.
absl::Status StatusOf(const v1::PreflightResult& result) {
  std::vector<std::string> failed;
  for (const v1::PreflightCheck& check : result.checks()) {
    if (check.verdict() == v1::CHECK_VERDICT_FAILED) failed.push_back(check.name());
  }
  if (failed.empty()) return absl::OkStatus();
  return Rejected(result.camera_uri(), "failed " + absl::StrJoin(failed, ", "),
                  "follow the remedies; until then its results are not certified");
}

absl::StatusOr<v1::PreflightResult> Measure(const Options& options) {
  EYEBOX_ASSIGN_OR_RETURN(capture::RigConfig config, RigOf(options.rig));
  if (options.seed != 0) config.seed = options.seed;
  if (!options.photodiode.empty()) config.photodiode_uri = options.photodiode;
  EYEBOX_ASSIGN_OR_RETURN(capture::Rig rig, capture::OpenRig(config, SystemClock()));
  if (rig.origin == capture::RecordingOrigin::kCaptured) {
    rig.presenter = std::make_unique<AskingPresenter>(stdin);
  }
  const int64_t begun_ns = SystemClock()->RealNs();
  EYEBOX_ASSIGN_OR_RETURN(
      const std::vector<Check> checks,
      RunPreflight(rig, rig.photodiode.get(), options.preflight, TerminalWatcher()));
  return DescribePreflight(checks, rig, options.preflight.exposures_s, begun_ns);
}

absl::Status Run(const Options& options) {
  EYEBOX_ASSIGN_OR_RETURN(const v1::PreflightResult result, Measure(options));
  if (!options.out.empty()) EYEBOX_RETURN_IF_ERROR(WritePreflight(options.out, result));
  if (options.json) {
    EYEBOX_RETURN_IF_ERROR(PrintJson(result));
  } else {
    PrintTable(result);
  }
  return StatusOf(result);
}

void Bind(CLI::App& command, Options& options) {
  command.add_option("rig", options.rig, "A rig file (.textproto) or a camera like aravis:ID")
      ->required();
  command.add_option("--photodiode", options.photodiode,
                     "Photodiode that looks at the display (default: the rig's)");
  command
      .add_option("--exposures", options.preflight.exposures_s,
                  "Exposures that will be used, s, by comma")
      ->delimiter(',')
      ->capture_default_str();
  command.add_option("--camera-px-per-display-px", options.preflight.camera_px_per_display_px,
                     "Camera pixels per display pixel, to name the beat");
  command.add_option("--seed", options.seed, "Of a simulated rig (default: the rig's, else 1)");
  command.add_option("--out", options.out,
                     "Folder for preflight.json, a recording for example (default: not kept)");
  command.add_flag("--json", options.json, "Print the result as JSON on stdout");
}

}  // namespace

void AddPreflight(CLI::App& app, Work& work) {
  AddCommand<Options>(app, work, "preflight",
                      "Prove by light that a rig measures light; exit status 5 if a check failed.",
                      "eyebox preflight rig.textproto --out preflight\n"
                      "  eyebox preflight 'sim:rift-s-like?fault=gamma'",
                      Bind, Run);
}

}  // namespace eyebox::service::cli
