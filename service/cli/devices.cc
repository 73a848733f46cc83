#include "service/devices.h"

#include <cstdio>

#include "service/cli/command.h"
#include "service/cli/terminal.h"

namespace eyebox::service::cli {
namespace {

struct Options {
  bool json = false;
};

void Print(const char* title, const google::protobuf::RepeatedPtrField<v1::Device>& devices) {
  std::printf("%s\n", title);
  if (devices.empty()) std::printf("  none\n");
  for (const v1::Device& device : devices) {
    std::printf("  %-28s %s\n", device.uri().c_str(), device.description().c_str());
    if (!device.problem().empty()) std::printf("    unusable: %s\n", device.problem().c_str());
  }
}

absl::Status Run(const Options& options) {
  const v1::DevicesResult devices = ListDevices();
  if (options.json) return PrintJson(devices);
  Print("cameras", devices.cameras());
  Print("photodiodes", devices.photodiodes());
  Print("triggers", devices.triggers());
  return absl::OkStatus();
}

}  // namespace

void AddDevices(CLI::App& app, Work& work) {
  AddCommand<Options>(
      app, work, "devices", "List cameras, photodiodes and triggers, as a rig file names them.",
      "eyebox devices",
      [](CLI::App& command, Options& options) {
        command.add_flag("--json", options.json, "Print the result as JSON on stdout");
      },
      Run);
}

}  // namespace eyebox::service::cli
