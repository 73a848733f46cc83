#include <cstdio>
#include <iostream>
#include <iterator>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "capture/base/file.h"
#include "capture/base/status.h"
#include "service/cli/colour_output.h"
#include "service/cli/command.h"
#include "service/cli/cube_modes.h"
#include "service/cli/share.h"
#include "service/cli/terminal.h"
#include "service/colour.h"
#include "service/result_json.h"
#include "service/single_steps.h"

namespace eyebox::service::cli {
namespace {

// Only for a fit of colours.
struct ColourChoices {
  std::optional<fit::ColourGamut> gamut;
  std::optional<fit::WhiteScale> scale;
  std::vector<double> white_point;  // x, y; empty for the gamut's own
};

// The modes beside designing one table.
struct Modes {
  std::string probe;
  std::string table;
  std::string readings;
  ProbeRequest probing;
  std::string recording;
  std::string field;
  FieldTablesRequest fielding;
  std::string tolerance = "2%";
};

struct Options {
  std::string fit;
  std::string out;
  Modes modes;
  CubeRequest request;
  ColourChoices colour;
  std::optional<int> size;
  std::string storage = "exact";
  std::string design_for = "exact";
  bool json = false;
};

const std::map<std::string, fit::TableTarget> kTargets = {{"hdrp", fit::TableTarget::kHdrp},
                                                          {"pps", fit::TableTarget::kPps},
                                                          {"resolve", fit::TableTarget::kResolve},
                                                          {"ptb", fit::TableTarget::kPtb}};
const std::map<std::string, fit::DesignMethod> kMethods = {
    {"minimax", fit::DesignMethod::kMinimax}, {"published", fit::DesignMethod::kPublished}};
constexpr int kUsualSize = 32;
constexpr int kGammaTableSize = 256;

const std::map<std::string, fit::ColourGamut> kGamuts = {{"native", fit::ColourGamut::kNative},
                                                         {"srgb", fit::ColourGamut::kSrgb},
                                                         {"p3", fit::ColourGamut::kP3}};
const std::map<std::string, fit::WhiteScale> kScales = {{"colours", fit::WhiteScale::kEveryColour},
                                                        {"white", fit::WhiteScale::kWhite}};

absl::StatusOr<std::string> ReadFit(const std::string& file) {
  constexpr size_t kLargestFitBytes = size_t{64} << 20;
  if (file != "-") return ReadWholeFile(file, kLargestFitBytes);
  return std::string(std::istreambuf_iterator<char>(std::cin), {});
}

absl::Status DesignForColours(const Options& options, const std::string& source,
                              const std::string& json) {
  const fit::DesignMethod method = options.request.design.method;
  if (options.storage != "exact" || options.design_for != "exact" ||
      method != fit::DesignMethod::kMinimax) {
    return BadInput(source,
                    "it is a fit of colours, and --storage, --design-for and --method are for "
                    "grey levels",
                    "leave them out");
  }
  ColourCubeRequest request;
  request.fit_source = source;
  EYEBOX_RETURN_IF_ERROR(ParseJson(json, request.fit_source, request.fit));
  request.target = options.request.target;
  request.size = options.size.value_or(kUsualSize);
  request.out = options.out;
  request.design.white_u = options.request.design.white_u;
  request.design.u_from = options.request.design.u_from;
  request.design.goal.gamut = options.colour.gamut.value_or(fit::ColourGamut::kNative);
  request.design.goal.scale = options.colour.scale.value_or(fit::WhiteScale::kEveryColour);
  if (const std::vector<double>& xy = options.colour.white_point; !xy.empty()) {
    request.design.goal.white = fit::Chromaticity{xy[0], xy[1]};
  }
  EYEBOX_ASSIGN_OR_RETURN(const v1::ColourCubeResult result, DesignColourCube(request));
  PrintWarnings(result.warnings());
  if (options.json) return PrintJson(result);
  PrintColourCertificate(result);
  std::printf("Wrote %s\n", options.out.c_str());
  return absl::OkStatus();
}

absl::Status Probing(const Options& options) {
  ProbeRequest request = options.modes.probing;
  EYEBOX_ASSIGN_OR_RETURN(const std::string json, ReadFit(options.modes.probe));
  request.cube = options.request;
  request.cube.fit_source = options.modes.probe;
  EYEBOX_RETURN_IF_ERROR(ParseJson(json, request.cube.fit_source, request.cube.fit));
  request.cube.size = options.size.value_or(kUsualSize);
  request.table = options.modes.table;
  request.readings = options.modes.readings;
  request.out = options.out;
  return RunProbe(request, options.json);
}

absl::Status DesigningForField(const Options& options) {
  FieldTablesRequest request = options.modes.fielding;
  request.recording = options.modes.recording;
  request.field = options.modes.field;
  request.out = options.out;
  EYEBOX_ASSIGN_OR_RETURN(request.design.tolerance,
                          ShareOf("--tolerance", options.modes.tolerance));
  request.design.target = options.request.target;
  request.design.size = options.size.value_or(kUsualSize);
  request.design.design = options.request.design;
  return RunFieldTables(request, options.json);
}

absl::Status Run(const Options& options) {
  if (!options.modes.probe.empty()) return Probing(options);
  if (options.out.empty()) return BadInput("--out", "is missing", "name what to write");
  if (options.fit.empty()) return DesigningForField(options);
  EYEBOX_ASSIGN_OR_RETURN(const std::string json, ReadFit(options.fit));
  CubeRequest request = options.request;
  request.fit_source = options.fit == "-" ? "standard input" : options.fit;
  if (IsColourFit(json)) return DesignForColours(options, request.fit_source, json);
  if (options.colour.gamut || options.colour.scale || !options.colour.white_point.empty()) {
    return BadInput(request.fit_source,
                    "it is a fit of grey levels, and --gamut, --scale and --white-point are for "
                    "colours",
                    "leave them out, or fit a series with columns m_r,m_g,m_b,x,y,z");
  }
  EYEBOX_RETURN_IF_ERROR(ParseJson(json, request.fit_source, request.fit));
  request.out = options.out;
  request.size = options.size.value_or(request.target == fit::TableTarget::kPtb ? kGammaTableSize
                                                                                : kUsualSize);
  EYEBOX_ASSIGN_OR_RETURN(request.storage, fit::StorageModelOf(options.storage));
  EYEBOX_ASSIGN_OR_RETURN(request.design.designed_for, fit::StorageModelOf(options.design_for));
  EYEBOX_ASSIGN_OR_RETURN(const v1::CubeResult result, DesignCube(request));
  PrintWarnings(result.warnings());
  if (options.json) return PrintJson(result);
  PrintCertificate(result);
  std::printf("Wrote %s\n", options.out.c_str());
  return absl::OkStatus();
}

void AddModes(CLI::App& command, CLI::App& source, Options& options) {
  Modes& modes = options.modes;
  source.add_option("--probe", modes.probe,
                    "A fit: patches whose readings tell whether its table reached the display");
  source.add_option("--recording", modes.recording,
                    "One table or many: for the field of this recording");
  source.add_option("--field", modes.field,
                    "The same for a folder with field_k.npy, field_delta.npy and activation.json");
  command.add_option("--table", modes.table,
                     "With --probe: the table as it was loaded (default: designed)");
  command.add_option("--readings", modes.readings,
                     "With --probe: CSV u,lum[,lum_sigma] or m_k,lum[,lum_sigma]; says what "
                     "happened to the table");
  command.add_option("--patches", modes.probing.patches, "With --probe: how many, 4 to 40")
      ->capture_default_str();
  command
      .add_option("--noise", modes.probing.noise_relative,
                  "With --probe: relative standard uncertainty of a reading")
      ->capture_default_str();
  command
      .add_option("--region", modes.fielding.region,
                  "With a field: all, or \"central D\" with D the diameter in degrees")
      ->capture_default_str();
  command
      .add_option("--tolerance", modes.tolerance,
                  "With a field: largest luminance error at any place, such as 2% or 0.02")
      ->capture_default_str();
  command
      .add_option("--place", modes.fielding.place_px, "With a field: side of a place, in pixels")
      ->capture_default_str();
  command.add_option("--series", modes.fielding.series, "With --recording: which series");
  command.add_option("--focal-length", modes.fielding.focal_length_px,
                     "With --field: in pixels, where the region is in degrees");
}

void AddColourOptions(CLI::App& command, ColourChoices& choices) {
  command
      .add_option("--gamut", choices.gamut,
                  "Of a colour fit: native (default), srgb or p3, the last two with D65")
      ->transform(OneOf(kGamuts));
  command
      .add_option("--white-point", choices.white_point,
                  "Of a colour fit: x,y of white (default: the gamut's own)")
      ->delimiter(',')
      ->expected(2);
  command
      .add_option(
          "--scale", choices.scale,
          "Of a colour fit: colours (default), the brightest white that leaves every colour "
          "reachable, or white, the brightest of all")
      ->transform(OneOf(kScales));
}

}  // namespace

void AddCube(CLI::App& app, Work& work) {
  AddCommand<Options>(
      app, work, "cube", "Design the lookup table that makes luminance proportional, with proof.",
      "eyebox cube --fit fit.json --target hdrp --size 32 --out linearize.cube\n"
      "  eyebox fit recording --json | eyebox cube --fit - --target pps --out linearize.png\n"
      "  eyebox cube --fit colourfit.json --target hdrp --gamut srgb --out colour.cube\n"
      "  eyebox cube --recording rec --target hdrp --region \"central 10\" --tolerance 2% --out "
      "set\n"
      "  eyebox cube --probe fit.json --target hdrp --out probe\n"
      "  eyebox cube --probe fit.json --target hdrp --readings read.csv",
      [](CLI::App& command, Options& options) {
        CubeRequest& request = options.request;
        auto* source = command.add_option_group("source", "Exactly one of");
        source->add_option("--fit", options.fit,
                           "What `eyebox fit --json` printed, or activation.json; - is stdin");
        AddModes(command, *source, options);
        source->require_option(1);
        command
            .add_option("--target", request.target,
                        "hdrp (.cube), pps (strip PNG), resolve (.cube) or ptb (256 x 3 text, for "
                        "load in MATLAB)")
            ->required()
            ->transform(OneOf(kTargets));
        command
            .add_option("--size", options.size,
                        "Entries per axis (default: 32, ptb: 256); pps: at most 32")
            ->check(CLI::Range(2, 256));
        command
            .add_option("--method", request.design.method,
                        "minimax (default) or published, the method of the literature")
            ->transform(OneOf(kMethods));
        command.add_option("--storage", options.storage,
                           "Certify also after half, r11g11b10, filter8, output8 (parted by "
                           "commas): each by itself and all together");
        command.add_option("--design-for", options.design_for,
                           "Take these into account in the design (hdrp, resolve)");
        command.add_option("--out", options.out, "File to write; a folder for --probe and fields");
        command
            .add_option("--white", request.design.white_u,
                        "Rendered value u that the display's maximum stands for")
            ->capture_default_str();
        AddColourOptions(command, options.colour);
        command
            .add_option("--u-from", request.design.u_from,
                        "Lower end of the certified range, as a fraction of white")
            ->capture_default_str();
        command.add_flag("--json", options.json, "Print the result as JSON on stdout");
      },
      Run);
}

}  // namespace eyebox::service::cli
