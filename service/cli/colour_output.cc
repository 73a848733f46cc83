#include "service/cli/colour_output.h"

#include <cstdio>

#include "service/cli/terminal.h"

namespace eyebox::service::cli {
namespace {

void PrintErrors(const char* label, const v1::Tristimulus& error) {
  std::printf("  %-24s X %.2f %%, Y %.2f %%, Z %.2f %%\n", label, 100 * error.x(), 100 * error.y(),
              100 * error.z());
}

}  // namespace

void PrintColourFit(const v1::ColourResult& result) {
  std::printf("  model %s\n", result.model().c_str());
  PrintErrors("rms error", result.rms_relative());
  PrintErrors("leave-one-out rms error", result.leave_one_out_rms_relative());
  std::printf("  %s\n", result.additivity().verdict().c_str());
  for (const v1::AdditivityLevel& level : result.additivity().levels()) {
    std::printf("    drive %-6.4g sum / white - 1: X %+6.1f %%, Y %+6.1f %%, Z %+6.1f %%\n",
                level.drive(), 100 * level.departure().x(), 100 * level.departure().y(),
                100 * level.departure().z());
  }
  for (const v1::ConstancyResult& test : result.constancy()) {
    if (!test.tested()) {
      std::printf("  %-6s chromaticity against level not tested\n", test.channel().c_str());
      continue;
    }
    std::printf("  %-6s %s its chromaticity: at most %.4f u'v' off, at drive %.4g\n",
                test.channel().c_str(), test.passed() ? "keeps" : "does not keep",
                test.max_distance(), test.at_drive());
  }
  std::printf("  models: %s\n", result.choice_reason().c_str());
  PrintParameters(result.parameters());
  std::printf("  %s\n", result.verdict().c_str());
}

void PrintColourCertificate(const v1::ColourCubeResult& cube) {
  std::printf("  %s %d, gamut %s: white %.4g cd/m2 (X %.4g, Z %.4g)\n", cube.target().c_str(),
              cube.size(), cube.gamut().c_str(), cube.white().y(), cube.white().x(),
              cube.white().z());
  for (const v1::ColourRampCertificate& ramp : cube.ramps()) {
    const v1::Certificate& luminance = ramp.luminance();
    std::printf(
        "  %-6s worst luminance error %.3f %% (at u = %.4f), rms %.3f %%, u %.2f to %.2f; "
        "chromaticity off by at most %.4f u'v' (at u = %.4f); bright enough up to u = %.4f\n",
        ramp.name().c_str(), 100 * luminance.max_relative(), luminance.at_u(),
        100 * luminance.rms_relative(), luminance.u_from(), luminance.u_to(),
        ramp.max_chromaticity_error(), ramp.at_u_chromaticity(), ramp.u_reachable());
  }
  std::printf(
      "  %d colours inside: worst luminance error %.3f %%, rms %.3f %%; chromaticity off by at "
      "most "
      "%.4f, rms %.4f u'v'; %d more lie outside what the display can show\n",
      cube.interior_colours(), 100 * cube.interior_max_relative(),
      100 * cube.interior_rms_relative(), cube.interior_max_chromaticity_error(),
      cube.interior_rms_chromaticity_error(), cube.interior_colours_outside());
  std::printf(
      "  %d entries from black to white: %d outside the gamut, %d limited by the light of black, "
      "%d too bright\n",
      cube.entries_in_range(), cube.entries_outside_gamut(), cube.entries_limited_by_black(),
      cube.entries_too_bright());
}

}  // namespace eyebox::service::cli
