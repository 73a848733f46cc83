#include <cstdio>
#include <string>

#include "capture/base/status.h"
#include "service/cli/command.h"
#include "service/cli/terminal.h"
#include "service/verify.h"

namespace eyebox::service::cli {
namespace {

struct Options {
  VerifyRequest request;
  std::string measured;
  std::string certificate;
  std::string out;
  bool json = false;
};

void Print(const v1::VerifyResult& result) {
  std::printf("  %s against u = %s, line through the origin\n", result.source().c_str(),
              result.input() == "srgb" ? "s(m)" : "m");
  PrintParameters(result.parameters());
  std::printf("  %-20s %12s %12s %10s %10s %9s\n", "asked for", "luminance", "line", "% of value",
              "% of max", "allowed");
  for (const v1::VerifyPoint& point : result.points()) {
    std::string asked;
    for (double m : point.asked()) {
      char text[16];
      std::snprintf(text, sizeof text, "%.4g ", m);
      asked += text;
    }
    std::printf("  %-20s %12.4f %12.4f %+10.3f %+10.3f", asked.c_str(), point.luminance(),
                point.line(), 100 * point.departure_of_value(), 100 * point.departure_of_maximum());
    if (point.judged()) std::printf(" %8.2f%%", 100 * point.allowed());
    std::printf("\n");
  }
  if (result.has_white_against_primaries()) {
    std::printf("  white over the sum of its primaries: %+.2f %%\n",
                100 * result.white_against_primaries().value());
  }
  if (result.places() > 0) {
    std::printf("  %d places of %d px, %d fail\n", result.places(), result.place_px(),
                result.places_failed());
  }
  std::printf("  %s: %s\n", result.verdict().c_str(), result.reason().c_str());
}

absl::Status Run(const Options& options) {
  VerifyRequest request = options.request;
  request.measured = options.measured;
  request.certificate = options.certificate;
  request.folder = options.out;
  EYEBOX_ASSIGN_OR_RETURN(const v1::VerifyResult result, Verify(request, TerminalWatcher()));
  PrintWarnings(result.warnings());
  if (options.json) {
    EYEBOX_RETURN_IF_ERROR(PrintJson(result));
  } else {
    Print(result);
  }
  if (result.verdict() != "fail") return absl::OkStatus();
  return Rejected(options.measured, "the table does not keep its certificate: " + result.reason(),
                  "try `eyebox cube --probe`, or fit and design again");
}

}  // namespace

void AddVerify(CLI::App& app, Work& work) {
  AddCommand<Options>(
      app, work, "verify",
      "Measure again through a table: proportional, and as well as certified?\n"
      "Luminance against u by a least-squares line through the origin; u = s(m) (HDRP) or u = m.\n"
      "Exit status 5 if the certificate is not kept.",
      "eyebox verify through_table.csv --certificate cube.json\n"
      "  eyebox verify second_recording --certificate cube.json --out maps --json",
      [](CLI::App& command, Options& options) {
        VerifyRequest& request = options.request;
        command
            .add_option("measured", options.measured,
                        "CSV with columns m_k,lum[,lum_sigma] or m_r,m_g,m_b,x,y,z, or a recording")
            ->required();
        command.add_option("--certificate", options.certificate,
                           "What `eyebox cube --json` printed; without it nothing is judged");
        command.add_option("--input", request.input,
                           "srgb (u = s(m)) or linear (u = m); default: srgb for HDRP tables and "
                           "without a certificate, linear for the others");
        command
            .add_option("--noise", request.noise_relative,
                        "Relative standard uncertainty of readings that come without one")
            ->capture_default_str();
        command.add_option("--series", request.series, "Series of a recording");
        command
            .add_option("--place", request.place_px, "Side of a place of a recording, in pixels")
            ->capture_default_str();
        command.add_option("--out", options.out, "Write the maps of a recording there as NPY");
        command.add_flag("--json", options.json, "Print the result as JSON on stdout");
      },
      Run);
}

}  // namespace eyebox::service::cli
