#include "capture/recording/recover.h"

#include <cstdio>
#include <string>

#include "capture/base/status.h"
#include "service/cli/command.h"

namespace eyebox::service::cli {
namespace {

struct Options {
  std::string recording;
};

void PrintCapture(const capture::RecoveredCapture& capture) {
  std::printf("Capture %d was under way: %d whole frames of %d\n", capture.number,
              capture.frames_kept, capture.frames_announced);
  for (const int row : capture.damaged_rows) std::printf("  frame %d is damaged\n", row);
  if (!capture.remark.empty()) std::printf("  not published: %s\n", capture.remark.c_str());
}

absl::Status Run(const Options& options) {
  EYEBOX_ASSIGN_OR_RETURN(const capture::RecoverReport report,
                          capture::RecoverRecording(options.recording));
  if (report.manifest_bytes_cut > 0) {
    std::printf("manifest.log ended within a record: %llu bytes cut\n",
                static_cast<unsigned long long>(report.manifest_bytes_cut));
  }
  if (report.capture) PrintCapture(*report.capture);
  for (const auto& file : report.kept_aside) std::printf("Kept %s\n", file.c_str());
  std::printf("Every frame of %s is as it was written: %lld frames in %d captures.\n",
              options.recording.c_str(), static_cast<long long>(report.verified.frames),
              report.verified.captures);
  return absl::OkStatus();
}

}  // namespace

void AddRecover(CLI::App& app, Work& work) {
  AddCommand<Options>(
      app, work, "recover", "Mend a recording that a crash or a power cut ended.",
      "eyebox recover recording",
      [](CLI::App& command, Options& options) {
        command.add_option("recording", options.recording, "Folder of the recording")->required();
      },
      Run);
}

}  // namespace eyebox::service::cli
