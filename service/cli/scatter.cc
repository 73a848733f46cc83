#include <cstdio>
#include <map>
#include <optional>
#include <string>

#include "capture/base/status.h"
#include "service/cli/command.h"
#include "service/cli/glare_output.h"
#include "service/cli/scatter_options.h"
#include "service/cli/terminal.h"
#include "service/scatter.h"

namespace eyebox::service::cli {
namespace {

struct Options {
  std::string recording;
  std::string csv;
  std::string reference;
  ScatterRequest request;
  bool json = false;
};

const std::map<std::string, optics::CoreShape> kCores = {{"gaussian", optics::CoreShape::kGaussian},
                                                         {"disk", optics::CoreShape::kDisk}};
const std::map<std::string, optics::TailShape> kTails = {
    {"moffat", optics::TailShape::kMoffat}, {"power_law", optics::TailShape::kPowerLaw}};

void PrintPredicted(const v1::ScatterResult& result) {
  for (const v1::PredictedPatch& patch : result.predicted()) {
    std::printf("  patch of %8.3g deg: p = (%.4f +- %.4f) p* + (%.4g +- %.2g) %s\n",
                patch.diameter_deg(), patch.slope(), patch.slope_sigma(), patch.offset(),
                patch.offset_sigma(), result.luminance_unit().c_str());
  }
}

absl::Status Run(const Options& options) {
  ScatterRequest request = options.request;
  request.source = options.csv.empty() ? options.recording : options.csv;
  request.reference = options.reference;
  EYEBOX_ASSIGN_OR_RETURN(const v1::ScatterResult result,
                          MeasureScatter(request, TerminalWatcher()));
  PrintWarnings(result.warnings());
  if (options.json) return PrintJson(result);
  std::printf("  w of the %s, chi-square %.4g for %d degrees of freedom; %s\n",
              result.kernel_of() == "headset" ? "headset alone" : "headset and instrument together",
              result.chi_square(), result.degrees_of_freedom(), result.identifiability().c_str());
  PrintParameters(result.parameters());
  PrintGlareFigures(result.figures());
  PrintPredicted(result);
  return absl::OkStatus();
}

void BindModel(CLI::App& command, ScatterRequest& request) {
  command.add_option("--core", request.fit.core, "gaussian, or disk for a pupil or a target")
      ->transform(OneOf(kCores));
  command.add_option("--tail", request.fit.tail, "moffat or power_law")->transform(OneOf(kTails));
  command
      .add_option(
          "--reach-deg", request.fit.reach_deg,
          "Beyond it w is 0. Unless given, a shorter one is taken where the readings say so")
      ->capture_default_str()
      ->each([&request](const std::string&) { request.fit.find_reach = false; });
  command.add_flag("--pedestal", request.fit.pedestal, "Fit an even pedestal too");
  command.add_option("--core-radius-deg", request.fit.core_radius_deg, "Hold the core's radius");
  command.add_option("--tail-radius-deg", request.fit.tail_radius_deg, "Hold the tail's radius");
  command.add_option("--tail-exponent", request.fit.tail_exponent, "Hold the tail's exponent");
  command.add_option("--background", request.fit.background_luminance,
                     "Hold the luminance of black");
}

void BindReading(CLI::App& command, ScatterRequest& request) {
  GlareOptions& glare = request.glare;
  command.add_option("--field-radius-deg", glare.field_radius_deg, "Of the display")
      ->capture_default_str();
  AddSurround(command, glare.surround);
  command
      .add_option("--spot-radius-px", glare.reading.spot_radius_px,
                  "Pixels around the axis that count as a reading (recordings)")
      ->capture_default_str();
  command
      .add_option("--model-sigma", glare.reading.model_relative_sigma,
                  "What the model leaves out of a reading, relative (recordings)")
      ->capture_default_str();
  command.add_flag("!--no-joint", request.joint,
                   "Take the field as even, instead of finding g and w together (recordings)");
}

}  // namespace

void AddScatter(CLI::App& app, Work& work) {
  AddCommand<Options>(
      app, work, "scatter",
      "Fit how light scatters, w(x), to disks, black disks and small sources.",
      "eyebox scatter recording --json > scatter.json\n"
      "  eyebox reduce recording --scatter scatter.json\n"
      "  eyebox scatter --csv readings.csv --core disk --predict 0.33,1,5,15",
      [](CLI::App& command, Options& options) {
        auto* source = command.add_option_group("source", "Exactly one of");
        source->add_option("recording", options.recording, "Folder of the recording");
        source->add_option("--csv", options.csv,
                           "Readings of a spot photometer, columns diameter_deg, pattern (disk, "
                           "black_disk, full_field, black), luminance[,sigma][,offset_deg]");
        source->require_option(1);
        command.add_option("--series", options.request.series, "Series (default: glare)");
        command.add_option("--reference", options.reference,
                           "The same series on a flat display, recording or CSV: tells the "
                           "instrument's glare from the headset's");
        command.add_option("--reference-series", options.request.reference_series,
                           "Its series (default: glare)");
        BindModel(command, options.request);
        BindReading(command, options.request);
        command
            .add_option("--predict", options.request.predict_deg,
                        "Diameters in deg, by comma, of patches whose readings are foretold "
                        "(default: over the whole field)")
            ->delimiter(',');
        command.add_option("--out", options.request.out,
                           "Write scatter.json and scatter.svg there");
        command.add_flag("--json", options.json, "Print the result as JSON on stdout");
      },
      Run);
}

}  // namespace eyebox::service::cli
