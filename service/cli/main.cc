// eyebox: one binary, the same functions as the service, usable without it.
#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <cstdio>
#include <string>

#include "capture/base/status.h"
#include "capture/base/version.h"
#include "service/cli/command.h"

namespace eyebox::service::cli {
namespace {

constexpr int kUsageExitCode = 2;

void AddAllCommands(CLI::App& app, Work& work) {
  AddPreflight(app, work);
  AddRun(app, work);
  AddDevices(app, work);
  AddCapture(app, work);
  AddReplay(app, work);
  AddImport(app, work);
  AddSimulate(app, work);
  AddReduce(app, work);
  AddUniformity(app, work);
  AddCharacterize(app, work);
  AddScatter(app, work);
  AddContrast(app, work);
  AddGeometry(app, work);
  AddPhotometry(app, work);
  AddFit(app, work);
  AddCube(app, work);
  AddPredict(app, work);
  AddKnots(app, work);
  AddPlan(app, work);
  AddTradeoff(app, work);
  AddVerify(app, work);
  AddVerifyFiles(app, work);
  AddCatalogue(app, work);
  AddRecover(app, work);
  AddPack(app, work);
  AddExport(app, work);
  AddServe(app, work);
}

int Main(int argc, char** argv) {
  CLI::App app("Measures the luminance that a head-mounted display sends to the eye.", "eyebox");
  app.set_version_flag("--version", std::string(kVersion));
  app.require_subcommand(1);
  app.footer(
      "Exit status: 0 done, 2 usage, 3 bad input, 4 device, 5 measurement rejected.\n"
      "Example:\n  eyebox run recording --out result");
  Work work;
  AddAllCommands(app, work);
  const auto is_named = [&](const CLI::App* command) { return command->check_name(argv[1]); };
  if (argc > 1 && argv[1][0] != '-' && app.get_subcommands(is_named).empty()) {
    std::fprintf(stderr, "eyebox: there is no command '%s'; eyebox --help lists them\n", argv[1]);
    return kUsageExitCode;
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kUsageExitCode;
  }
  const absl::Status status = work();
  if (!status.ok()) {
    std::fprintf(stderr, "eyebox: %s\n", std::string(status.message()).c_str());
  }
  return ExitCodeFor(status);
}

}  // namespace
}  // namespace eyebox::service::cli

int main(int argc, char** argv) { return eyebox::service::cli::Main(argc, argv); }
