#include <cstdio>
#include <string>

#include "capture/base/status.h"
#include "capture/recording/reader.h"
#include "service/cli/command.h"
#include "service/cli/terminal.h"
#include "service/results/parameter.h"

namespace eyebox::service::cli {
namespace {

struct Options {
  std::string recording;
  bool json = false;
};

absl::Status Run(const Options& options) {
  EYEBOX_ASSIGN_OR_RETURN(const capture::VerifyReport report,
                          capture::VerifyRecording(options.recording));
  v1::VerifyFilesResult result;
  auto& parameters = *result.mutable_parameters();
  AddParameter(parameters, "captures", report.captures, 0, "1");
  AddParameter(parameters, "frames", static_cast<double>(report.frames), 0, "1");
  AddParameter(parameters, "bytes", static_cast<double>(report.bytes), 0, "byte");
  result.set_recording(options.recording);
  if (options.json) return PrintJson(result);
  PrintParameters(result.parameters());
  std::printf("Every frame of %s is as it was written.\n", options.recording.c_str());
  return absl::OkStatus();
}

}  // namespace

void AddVerifyFiles(CLI::App& app, Work& work) {
  AddCommand<Options>(
      app, work, "verify-files", "Compare every byte of a recording with its checksums.",
      "eyebox verify-files recording",
      [](CLI::App& command, Options& options) {
        command.add_option("recording", options.recording, "Folder of the recording")->required();
        command.add_flag("--json", options.json, "Print the result as JSON on stdout");
      },
      Run);
}

}  // namespace eyebox::service::cli
