#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <string>
#include <system_error>
#include <utility>

#include "capture/base/status.h"
#include "service/cli/command.h"
#include "service/cli/run_output.h"
#include "service/cli/terminal.h"
#include "service/pipeline.h"

namespace eyebox::service::cli {
namespace {

struct Options {
  std::string source;
  std::string recording;
  RunOutput output;
};

// A folder that is gone when this is.
class TemporaryFolder {
 public:
  static absl::StatusOr<TemporaryFolder> In(const std::filesystem::path& parent) {
    std::error_code error;
    std::filesystem::create_directories(parent, error);
    std::string name = (parent / ".replayed-XXXXXX").string();
    if (error || ::mkdtemp(name.data()) == nullptr) {
      return SystemFailed(parent.string(), error ? error.value() : errno,
                          "choose a folder that can be written with --out");
    }
    return TemporaryFolder(std::move(name));
  }
  TemporaryFolder(TemporaryFolder&& other) noexcept : path_(std::exchange(other.path_, {})) {}
  TemporaryFolder& operator=(TemporaryFolder&&) = delete;
  ~TemporaryFolder() {
    std::error_code ignored;
    if (!path_.empty()) std::filesystem::remove_all(path_, ignored);
  }
  const std::filesystem::path& path() const { return path_; }

 private:
  explicit TemporaryFolder(std::string path) : path_(std::move(path)) {}
  std::filesystem::path path_;
};

absl::Status Run(const Options& options) {
  const std::filesystem::path source = options.source;
  const auto out = options.output.FolderOr(source / "results" / "replay");
  if (!options.recording.empty()) {
    return options.output.Print(
        ReplayRecording(source, options.recording, out, options.output.run, TerminalWatcher()),
        out);
  }
  if (!std::filesystem::is_directory(source)) {
    return Missing(options.source, "no such recording", "give the folder of a recording");
  }
  EYEBOX_ASSIGN_OR_RETURN(const TemporaryFolder folder, TemporaryFolder::In(out));
  return options.output.Print(ReplayRecording(source, folder.path() / "recording", out,
                                              options.output.run, TerminalWatcher()),
                              out);
}

}  // namespace

void AddReplay(CLI::App& app, Work& work) {
  AddCommand<Options>(
      app, work, "replay",
      "Play a recording back as if its camera stood there again, record it, and do all of run.",
      "eyebox replay recording --out result",
      [](CLI::App& command, Options& options) {
        command.add_option("source", options.source, "Folder of the recording")->required();
        options.output.AddTo(command, "SOURCE/results/replay");
        command.add_option("--recording", options.recording,
                           "Keep the new recording there; must not exist (default: not kept)");
      },
      Run);
}

}  // namespace eyebox::service::cli
