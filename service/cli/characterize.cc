#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "capture/base/status.h"
#include "service/cli/command.h"
#include "service/cli/terminal.h"
#include "service/results/characterize.h"
#include "service/steps/characterize.h"

namespace eyebox::service::cli {
namespace {

constexpr int kBarCells = 40;
constexpr int kRowsShown = 24;

struct Options {
  std::string recording;
  std::string descriptor;
  std::string out;
  bool json = false;
};

// The photon-transfer curve, one bar a step: noise against signal.
void PrintSteps(const v1::CharacterizeResult& result) {
  double largest = 0;
  for (const v1::PhotonTransferStep& step : result.steps()) {
    largest = std::max(largest, step.temporal_variance_dn2());
  }
  if (!(largest > 0)) return;
  std::printf("\n  signal [DN]  variance [DN^2]  off line [%%]\n");
  const int stride = (result.steps_size() + kRowsShown - 1) / kRowsShown;
  for (int k = 0; k < result.steps_size(); k += stride) {
    const v1::PhotonTransferStep& step = result.steps(k);
    const auto cells =
        static_cast<size_t>(std::lround(kBarCells * step.temporal_variance_dn2() / largest));
    char deviation[32] = "-";
    if (step.has_linearity_deviation()) {
      std::snprintf(deviation, sizeof deviation, "%+.3f", 100 * step.linearity_deviation());
    }
    std::printf("  %11.2f  %15.3f  %12s  |%s\n", step.signal_dn(), step.temporal_variance_dn2(),
                deviation, std::string(cells, '#').c_str());
  }
}

void PrintSummary(const v1::CharacterizeResult& result) {
  std::printf("%s, %s: %d steps, %d bits, gain %g dB, %d x %d pixels from (%d, %d)\n",
              result.release().c_str(), result.source().c_str(), result.steps_size(), result.bits(),
              result.gain_db(), result.region_width_px(), result.region_height_px(),
              result.region_left_px(), result.region_top_px());
  PrintParameters(result.parameters());
  std::printf("  %d defective pixels: hot %.4f %%, dead or unlike their neighbours %.4f %%\n",
              result.defective_pixels(), 100 * result.hot_share(), 100 * result.dead_share());
  PrintSteps(result);
}

absl::Status Run(const Options& options) {
  if (options.recording.empty() == options.descriptor.empty()) {
    return BadInput("characterize", "it needs one source",
                    "give a recording, or a descriptor with --emva1288");
  }
  EYEBOX_ASSIGN_OR_RETURN(const CharacterizedSensor sensor,
                          options.descriptor.empty()
                              ? CharacterizeRecording(options.recording, TerminalWatcher())
                              : CharacterizeDescriptor(options.descriptor, TerminalWatcher()));
  EYEBOX_ASSIGN_OR_RETURN(const v1::CharacterizeResult result, DescribeSensor(sensor, options.out));
  PrintWarnings(result.warnings());
  if (options.json) return PrintJson(result);
  PrintSummary(result);
  return absl::OkStatus();
}

}  // namespace

void AddCharacterize(CLI::App& app, Work& work) {
  AddCommand<Options>(
      app, work, "characterize", "Characterise the camera's sensor by EMVA 1288.",
      "eyebox characterize --emva1288 series.txt --out sensor",
      [](CLI::App& command, Options& options) {
        auto* recording = command.add_option("recording", options.recording,
                                             "Folder of a recording with darks and even light");
        command
            .add_option("--emva1288", options.descriptor,
                        "EMVA 1288 descriptor file (lines v, n, b, d, i)")
            ->excludes(recording);
        command.add_option("--out", options.out, "Write sensor.json and defects.npy there");
        command.add_flag("--json", options.json, "Print the result as JSON on stdout");
      },
      Run);
}

}  // namespace eyebox::service::cli
