#include "capture/recording/export.h"

#include <cstdio>
#include <map>
#include <string>

#include "capture/base/status.h"
#include "service/cli/command.h"
#include "service/cli/terminal.h"

namespace eyebox::service::cli {
namespace {

struct Options {
  std::string recording;
  std::string out;
  capture::ExportFilter filter;
};

absl::Status Run(const Options& options) {
  const Watcher watcher = TerminalWatcher();
  EYEBOX_ASSIGN_OR_RETURN(
      const capture::ExportReport report,
      capture::ExportTiff(options.recording, options.out, options.filter,
                          [&watcher](int done, int total) {
                            watcher.progress({static_cast<double>(done) / total,
                                              "exporting " + std::to_string(total) + " captures"});
                          }));
  std::printf("%lld frames of %d captures\nWrote %s\n", static_cast<long long>(report.frames),
              report.captures, options.out.c_str());
  return absl::OkStatus();
}

void Bind(CLI::App& command, Options& options) {
  static const std::map<std::string, FrameKind> kKinds = {
      {"light", FrameKind::kLight}, {"dark", FrameKind::kDark}, {"flat", FrameKind::kFlat}};
  command.add_option("recording", options.recording, "Folder of the recording")->required();
  command.add_option("--out", options.out, "Folder of the frames; must not exist")->required();
  command
      .add_option_function<FrameKind>(
          "--kind", [&options](const FrameKind& kind) { options.filter.kind = kind; },
          "Only light, dark or flat")
      ->transform(OneOf(kKinds));
  command.add_option_function<std::string>(
      "--series", [&options](const std::string& series) { options.filter.series = series; },
      "Only this series; '' is the main one");
}

}  // namespace

void AddExport(CLI::App& app, Work& work) {
  AddCommand<Options>(app, work, "export",
                      "Write frames as 16-bit TIFF and an index.csv that import reads.",
                      "eyebox export recording --out frames --kind light", Bind, Run);
}

}  // namespace eyebox::service::cli
