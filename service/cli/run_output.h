// What the commands that do everything have in common.
#ifndef EYEBOX_SERVICE_CLI_RUN_OUTPUT_H_
#define EYEBOX_SERVICE_CLI_RUN_OUTPUT_H_

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <filesystem>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "service/pipeline.h"

namespace eyebox::service::cli {

struct RunOutput {
  std::string out;
  bool json = false;
  RunOptions run;

  // --out, --json, --hdrp-size, --pps-size.
  void AddTo(CLI::App& command, const std::string& default_out);
  std::filesystem::path FolderOr(const std::filesystem::path& fallback) const {
    return out.empty() ? fallback : std::filesystem::path(out);
  }
  // The result as JSON or in words, warnings on stderr.
  absl::Status Print(const absl::StatusOr<v1::RunResult>& result,
                     const std::filesystem::path& folder) const;
};

}  // namespace eyebox::service::cli

#endif  // EYEBOX_SERVICE_CLI_RUN_OUTPUT_H_
