// A command of the binary: its options are bound while parsing, its work runs afterwards.
#ifndef EYEBOX_SERVICE_CLI_COMMAND_H_
#define EYEBOX_SERVICE_CLI_COMMAND_H_

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <CLI/Validators.hpp>
#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "absl/status/status.h"

namespace eyebox::service::cli {

// What the parsed command line asks for; main() runs it once parsing is over.
using Work = std::function<absl::Status()>;

// Adds a subcommand whose options live in `Options` until its work has run. `bind` declares the
// options on the subcommand, `run` does the work.
template <typename Options, typename Bind, typename Run>
void AddCommand(CLI::App& app, Work& work, const std::string& name, const std::string& description,
                const std::string& example, Bind bind, Run run) {
  CLI::App* command = app.add_subcommand(name, description);
  command->footer("Example:\n  " + example);
  auto options = std::make_shared<Options>();
  bind(*command, *options);
  command->callback([&work, options, run] { work = [options, run] { return run(*options); }; });
}

// For an option whose value is one of the names of `named`; --help lists the names alone.
template <typename Named>
CLI::CheckedTransformer OneOf(const Named& named) {
  std::string names;
  for (const auto& [name, value] : named) names += (names.empty() ? "{" : ",") + name;
  CLI::CheckedTransformer transformer(named);
  transformer.description(names + "}");
  return transformer;
}

inline constexpr char kSensorHelp[] =
    "Folder that characterize --out wrote of this camera (default: the copy in the recording, "
    "else estimated from the frames)";

void AddCapture(CLI::App& app, Work& work);
void AddContrast(CLI::App& app, Work& work);
void AddDevices(CLI::App& app, Work& work);
void AddImport(CLI::App& app, Work& work);
void AddScatter(CLI::App& app, Work& work);
void AddSimulate(CLI::App& app, Work& work);
void AddReduce(CLI::App& app, Work& work);
void AddUniformity(CLI::App& app, Work& work);
void AddCatalogue(CLI::App& app, Work& work);
void AddCharacterize(CLI::App& app, Work& work);
void AddGeometry(CLI::App& app, Work& work);
void AddPhotometry(CLI::App& app, Work& work);
void AddFit(CLI::App& app, Work& work);
void AddCube(CLI::App& app, Work& work);
void AddPredict(CLI::App& app, Work& work);
void AddKnots(CLI::App& app, Work& work);
void AddPlan(CLI::App& app, Work& work);
void AddTradeoff(CLI::App& app, Work& work);
void AddPreflight(CLI::App& app, Work& work);
void AddRun(CLI::App& app, Work& work);
void AddReplay(CLI::App& app, Work& work);
void AddVerify(CLI::App& app, Work& work);
void AddVerifyFiles(CLI::App& app, Work& work);
void AddRecover(CLI::App& app, Work& work);
void AddPack(CLI::App& app, Work& work);
void AddExport(CLI::App& app, Work& work);
void AddServe(CLI::App& app, Work& work);

}  // namespace eyebox::service::cli

#endif  // EYEBOX_SERVICE_CLI_COMMAND_H_
