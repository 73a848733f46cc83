// What is known of the camera from elsewhere, as options.
#ifndef EYEBOX_SERVICE_CLI_KNOWN_OPTIONS_H_
#define EYEBOX_SERVICE_CLI_KNOWN_OPTIONS_H_

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <filesystem>

namespace eyebox::service::cli {

inline void AddScale(CLI::App& command, std::filesystem::path& scale) {
  command.add_option("--scale", scale,
                     "Luminance of 1 DN/s: what eyebox photometry scale wrote, at the same gain");
}

inline void AddGeometryChoice(CLI::App& command, std::filesystem::path& geometry) {
  command.add_option("--geometry", geometry,
                     "Where pixels look: what eyebox geometry wrote (default: the recording's)");
}

}  // namespace eyebox::service::cli

#endif  // EYEBOX_SERVICE_CLI_KNOWN_OPTIONS_H_
