#include <cstdio>
#include <string>

#include "capture/base/status.h"
#include "capture/recording/pack.h"
#include "service/cli/command.h"
#include "service/cli/terminal.h"

namespace eyebox::service::cli {
namespace {

struct Options {
  std::string recording;
  std::string out;
};

absl::Status Run(const Options& options) {
  const Watcher watcher = TerminalWatcher();
  EYEBOX_ASSIGN_OR_RETURN(
      const capture::PackReport report,
      capture::PackRecording(options.recording, options.out, [&watcher](int done, int total) {
        watcher.progress(
            {static_cast<double>(done) / total, "packing " + std::to_string(total) + " captures"});
      }));
  std::printf("%lld frames, %.2f MB, were %.2f MB\nWrote %s\n",
              static_cast<long long>(report.frames), static_cast<double>(report.bytes_after) / 1e6,
              static_cast<double>(report.bytes_before) / 1e6, options.out.c_str());
  return absl::OkStatus();
}

}  // namespace

void AddPack(CLI::App& app, Work& work) {
  AddCommand<Options>(
      app, work, "pack", "Copy a recording, compressed without loss, every frame verified.",
      "eyebox pack recording --out recording-packed",
      [](CLI::App& command, Options& options) {
        command.add_option("recording", options.recording, "Folder of the recording")->required();
        command.add_option("--out", options.out, "The packed recording; must not exist")
            ->required();
      },
      Run);
}

}  // namespace eyebox::service::cli
