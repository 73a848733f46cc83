#include <cstdio>
#include <iostream>
#include <iterator>
#include <map>
#include <string>

#include "capture/base/status.h"
#include "service/cli/command.h"
#include "service/cli/terminal.h"
#include "service/result_json.h"
#include "service/single_steps.h"

namespace eyebox::service::cli {
namespace {

struct Options {
  std::string fit;
  std::string out;
  CubeRequest request;
  bool json = false;
};

const std::map<std::string, fit::TableTarget> kTargets = {{"hdrp", fit::TableTarget::kHdrp},
                                                          {"pps", fit::TableTarget::kPps},
                                                          {"resolve", fit::TableTarget::kResolve}};

absl::Status ReadFit(const std::string& file, v1::ActivationResult& result) {
  if (file != "-") return ReadJson(file, result);
  const std::string text(std::istreambuf_iterator<char>(std::cin), {});
  return ParseJson(text, "standard input", result);
}

absl::Status Run(const Options& options) {
  CubeRequest request = options.request;
  EYEBOX_RETURN_IF_ERROR(ReadFit(options.fit, request.fit));
  request.fit_source = options.fit == "-" ? "standard input" : options.fit;
  request.out = options.out;
  EYEBOX_ASSIGN_OR_RETURN(const v1::CubeResult result, DesignCube(request));
  PrintWarnings(result.warnings());
  if (options.json) return PrintJson(result);
  PrintCertificate(result);
  std::printf("Wrote %s\n", options.out.c_str());
  return absl::OkStatus();
}

}  // namespace

void AddCube(CLI::App& app, Work& work) {
  AddCommand<Options>(
      app, work, "cube", "Design the lookup table that makes luminance proportional, with proof.",
      "eyebox cube --fit fit.json --target hdrp --size 32 --out linearize.cube\n"
      "  eyebox fit recording --json | eyebox cube --fit - --target pps --out linearize.png",
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
        command
            .add_option("--u-from", request.design.u_from,
                        "Lower end of the certified range, as a fraction of white")
            ->capture_default_str();
        command.add_flag("--json", options.json, "Print the result as JSON on stdout");
      },
      Run);
}

}  // namespace eyebox::service::cli
