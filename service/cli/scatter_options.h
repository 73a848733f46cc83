// Which scatter is taken out of a camera's images, as options.
#ifndef EYEBOX_SERVICE_CLI_SCATTER_OPTIONS_H_
#define EYEBOX_SERVICE_CLI_SCATTER_OPTIONS_H_

#include <map>
#include <string>

#include "service/cli/command.h"
#include "service/steps/take_scatter_out.h"

namespace eyebox::service::cli {

inline void AddSurround(CLI::App& command, optics::Surround& surround) {
  static const std::map<std::string, optics::Surround> kNames = {
      {"unknown", optics::Surround::kUnknown},
      {"continued", optics::Surround::kContinued},
      {"dark", optics::Surround::kDark}};
  command
      .add_option("--surround", surround,
                  "Beside the image the display is dark, continued as at its border, or unknown "
                  "(as continued, but counted as uncertain)")
      ->transform(OneOf(kNames));
}

// --scatter and --surround.
inline void AddScatterChoice(CLI::App& command, ScatterChoice& choice) {
  command.add_option("--scatter", choice.file,
                     "Take this scatter out: what eyebox scatter --json printed");
  AddSurround(command, choice.surround);
}

}  // namespace eyebox::service::cli

#endif  // EYEBOX_SERVICE_CLI_SCATTER_OPTIONS_H_
