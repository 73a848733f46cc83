#include "service/cli/run_output.h"

#include <cstdio>

#include "capture/base/status.h"
#include "eyebox/v1/budget.pb.h"
#include "service/cli/budget_output.h"
#include "service/cli/terminal.h"
#include "service/result_json.h"

namespace eyebox::service::cli {

void RunOutput::AddTo(CLI::App& command, const std::string& default_out) {
  command.add_option("--out", out, "Folder of the results (default: " + default_out + ")");
  command.add_flag("--json", json, "Print the result as JSON on stdout");
  command.add_option("--hdrp-size", run.hdrp_cube_size, "Entries per axis of the HDRP cube")
      ->check(CLI::Range(2, 129))
      ->capture_default_str();
  command.add_option("--pps-size", run.pps_strip_size, "Entries per axis of the strip PNG")
      ->check(CLI::Range(2, 32))
      ->capture_default_str();
  command
      .add_option("--clip", run.clip_sigmas,
                  "Leave out frames this many sigmas off, 3 or more (default: none)")
      ->check(CLI::Range(3.0, 100.0));
}

absl::Status RunOutput::Print(const absl::StatusOr<v1::RunResult>& result,
                              const std::filesystem::path& folder) const {
  if (!result.ok()) return result.status();
  PrintWarnings(result->warnings());
  if (json) return PrintJson(*result);
  PrintParameters(result->parameters());
  PrintParameters(result->uniformity().parameters());
  for (const v1::CubeResult& cube : result->cubes()) PrintCertificate(cube);
  v1::BudgetResult budget;
  EYEBOX_RETURN_IF_ERROR(ReadJson(folder / "budget.json", budget));
  PrintBudget(budget);
  std::printf("See %s\n", (folder / "report.html").c_str());
  return absl::OkStatus();
}

}  // namespace eyebox::service::cli
