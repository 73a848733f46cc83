#include <cstdio>
#include <string>

#include "capture/base/status.h"
#include "service/cli/cube_modes.h"
#include "service/cli/terminal.h"

namespace eyebox::service::cli {
namespace {

void PrintTable(const char* what, const v1::RegionTable& region) {
  std::printf("  %-8s %-14s %8d places, worst %.3f %% +- %.3f %% (delta / k %.5f, gamma %.4f)\n",
              what, region.table().file().c_str(), region.places(), 100 * region.max_relative(),
              100 * region.max_relative_sigma(), region.offset_over_gain(), region.gamma());
}

}  // namespace

absl::Status RunFieldTables(const FieldTablesRequest& request, bool json) {
  EYEBOX_ASSIGN_OR_RETURN(const v1::CubeSetResult result,
                          DesignFieldTables(request, TerminalWatcher()));
  PrintWarnings(result.warnings());
  if (json) return PrintJson(result);
  std::printf("  %s\n", result.explanation().c_str());
  PrintTable("single", result.single());
  for (const v1::RegionTable& table : result.tables()) PrintTable("", table);
  std::printf("  %d tables keep %s within %.3g %%%s\n", result.tables_size(),
              result.region().c_str(), 100 * request.design.tolerance,
              result.proven_smallest() ? "; fewer do not" : "; fewer might");
  return absl::OkStatus();
}

}  // namespace eyebox::service::cli
