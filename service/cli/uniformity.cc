#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>

#include "capture/base/status.h"
#include "service/cli/command.h"
#include "service/cli/known_options.h"
#include "service/cli/scatter_options.h"
#include "service/cli/terminal.h"
#include "service/single_steps.h"

namespace eyebox::service::cli {
namespace {

struct Options {
  std::string recording;
  std::optional<std::string> series;
  std::string sensor;
  ScatterChoice scatter;
  std::filesystem::path geometry;
  std::string out;
  bool json = false;
};

const char* UnitOf(const v1::CrossValidatedModel& model) {
  return model.model() == "spline" ? "intervals" : "orders";
}

void PrintDetail(const v1::UniformityDetail& detail) {
  for (const v1::CrossValidatedModel& model : detail.cross_validation()) {
    if (model.best()) {
      std::printf("  %s of %d %s predicts best of its kind: held-out chi-square %.4f a pixel\n",
                  model.model().c_str(), model.size(), UnitOf(model), model.held_out_chi_square());
    }
    if (model.fitted()) {
      std::printf("  %s of %d %s was fitted%s: held-out chi-square %.4f a pixel\n",
                  model.model().c_str(), model.size(), UnitOf(model),
                  model.model() == detail.smooth_model() ? ", and taken" : "",
                  model.held_out_chi_square());
    }
  }
  std::printf("  the pixels determine %.1f functions of the model taken\n",
              detail.effective_functions());
  const v1::LevelIndependence& levels = detail.level_independence();
  if (!levels.reason().empty()) {
    std::printf("  whether g is the same at all levels is not known: %s\n",
                levels.reason().c_str());
    return;
  }
  std::printf(
      "  g is %s at all levels: chi-square %.4g for %.0f degrees of freedom, p = %.3g; %.1f "
      "%% of the blocks fail at 5 %%\n",
      levels.independent() ? "the same" : "not the same", levels.chi_square(),
      levels.degrees_of_freedom(), levels.p_value(), 100 * levels.failing_share());
}

absl::Status Run(const Options& options) {
  EYEBOX_ASSIGN_OR_RETURN(const v1::UniformityResult result,
                          MapUniformity({.recording = options.recording,
                                         .series = options.series,
                                         .sensor = options.sensor,
                                         .scatter = options.scatter,
                                         .geometry = options.geometry},
                                        options.out, TerminalWatcher()));
  PrintWarnings(result.warnings());
  if (options.json) return PrintJson(result);
  PrintParameters(result.parameters());
  PrintDetail(result.detail());
  for (const v1::UniformityPoint& point : result.points_9()) {
    std::printf("  g(%.1f px, %.1f px) = %.4f +- %.4f\n", point.x_px(), point.y_px(), point.g(),
                point.sigma());
  }
  return absl::OkStatus();
}

}  // namespace

void AddUniformity(CLI::App& app, Work& work) {
  AddCommand<Options>(
      app, work, "uniformity", "Map the nonuniformity g(x) of the brightest grey full field.",
      "eyebox uniformity recording --out maps --json",
      [](CLI::App& command, Options& options) {
        command.add_option("recording", options.recording, "Folder of the recording")->required();
        command.add_option("--series", options.series, "Series (default: the main or only one)");
        command.add_option("--sensor", options.sensor, kSensorHelp);
        AddScatterChoice(command, options.scatter);
        AddGeometryChoice(command, options.geometry);
        command.add_option("--out", options.out, "Write raw and smooth g with sigma there as NPY");
        command.add_flag("--json", options.json, "Print the result as JSON on stdout");
      },
      Run);
}

}  // namespace eyebox::service::cli
