#include <cstdio>
#include <string>

#include "capture/base/clock.h"
#include "capture/base/status.h"
#include "capture/recording/import.h"
#include "service/cli/command.h"
#include "service/cli/terminal.h"
#include "service/results/parameter.h"

namespace eyebox::service::cli {
namespace {

struct Options {
  std::string folder;
  std::string out;
  bool json = false;
};

absl::Status Run(const Options& options) {
  const Watcher watcher = TerminalWatcher();
  EYEBOX_ASSIGN_OR_RETURN(
      const capture::ImportReport report,
      capture::ImportFolder(
          options.folder, options.out, SystemClock(), [&watcher](int64_t done, int64_t total) {
            watcher.progress({static_cast<double>(done) / static_cast<double>(total),
                              "importing " + std::to_string(total) + " frames"});
          }));
  v1::ImportResult result;
  AddParameter(*result.mutable_parameters(), "frames", static_cast<double>(report.frames), 0, "1");
  AddParameter(*result.mutable_parameters(), "captures", report.captures, 0, "1");
  result.set_recording(options.out);
  AddAll(*result.mutable_series(), report.series);
  if (options.json) return PrintJson(result);
  PrintParameters(result.parameters());
  for (const std::string& series : report.series) std::printf("  series %s\n", series.c_str());
  std::printf("Wrote %s\n", options.out.c_str());
  return absl::OkStatus();
}

}  // namespace

void AddImport(CLI::App& app, Work& work) {
  AddCommand<Options>(
      app, work, "import", "Make a recording of TIFF or PNG frames and their index.csv.",
      "eyebox import frames --out recording",
      [](CLI::App& command, Options& options) {
        command
            .add_option("folder", options.folder,
                        "Holds the frames and index.csv with columns "
                        "file,kind,exposure_s,gain_db,series,repeat[,...]")
            ->required();
        command.add_option("--out", options.out, "The recording; must not exist")->required();
        command.add_flag("--json", options.json, "Print the result as JSON on stdout");
      },
      Run);
}

}  // namespace eyebox::service::cli
