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

struct Options {
  std::string fit;
  std::string out;
  CubeRequest request;
  ColourChoices colour;
  bool json = false;
};

const std::map<std::string, fit::TableTarget> kTargets = {{"hdrp", fit::TableTarget::kHdrp},
                                                          {"pps", fit::TableTarget::kPps},
                                                          {"resolve", fit::TableTarget::kResolve}};

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
  ColourCubeRequest request;
  request.fit_source = source;
  EYEBOX_RETURN_IF_ERROR(ParseJson(json, request.fit_source, request.fit));
  request.target = options.request.target;
  request.size = options.request.size;
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

absl::Status Run(const Options& options) {
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
  EYEBOX_ASSIGN_OR_RETURN(const v1::CubeResult result, DesignCube(request));
  PrintWarnings(result.warnings());
  if (options.json) return PrintJson(result);
  PrintCertificate(result);
  std::printf("Wrote %s\n", options.out.c_str());
  return absl::OkStatus();
}

void AddColourOptions(CLI::App& command, ColourChoices& choices) {
  command
      .add_option("--gamut", choices.gamut,
                  "Of a colour fit: native (default), srgb or p3, the last two with D65")
      ->transform(CLI::CheckedTransformer(kGamuts));
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
      ->transform(CLI::CheckedTransformer(kScales));
}

}  // namespace

void AddCube(CLI::App& app, Work& work) {
  AddCommand<Options>(
      app, work, "cube", "Design the lookup table that makes luminance proportional, with proof.",
      "eyebox cube --fit fit.json --target hdrp --size 32 --out linearize.cube\n"
      "  eyebox fit recording --json | eyebox cube --fit - --target pps --out linearize.png\n"
      "  eyebox cube --fit colourfit.json --target hdrp --gamut srgb --out colour.cube",
      [](CLI::App& command, Options& options) {
        CubeRequest& request = options.request;
        command
            .add_option("--fit", options.fit,
                        "What `eyebox fit --json` printed, or activation.json; - is stdin")
            ->required();
        command
            .add_option("--target", request.target,
                        "hdrp (.cube), pps (strip PNG) or resolve (.cube)")
            ->required()
            ->transform(CLI::CheckedTransformer(kTargets));
        command.add_option("--size", request.size, "Entries per axis; pps: at most 32")
            ->check(CLI::Range(2, 129))
            ->capture_default_str();
        command.add_option("--out", options.out, "File to write")->required();
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
