#include <cstdio>
#include <string>

#include "capture/base/status.h"
#include "service/cli/cube_modes.h"
#include "service/cli/terminal.h"

namespace eyebox::service::cli {
namespace {

void PrintPlan(const v1::ProbeResult& result) {
  std::printf("  %d patches; expected luminance, right table:\n", result.patches_size());
  for (const v1::ProbePatch& patch : result.patches()) {
    std::printf("  u %8.5f  m %8.5f  %12.4f\n", patch.u(), patch.m_k(), patch.expected(0));
  }
  for (const std::string& pair : result.indistinguishable()) {
    std::printf("  cannot be told apart at this noise: %s\n", pair.c_str());
  }
  for (const std::string& file : result.files()) std::printf("Wrote %s\n", file.c_str());
}

void PrintVerdict(const v1::ProbeResult& result) {
  for (const v1::ProbeHypothesis& hypothesis : result.hypotheses()) {
    std::printf("  %-24s chi-square %10.2f  log likelihood ratio %10.2f  probability %.5f",
                hypothesis.name().c_str(), hypothesis.chi_square(),
                hypothesis.log_likelihood_ratio(), hypothesis.probability());
    if (hypothesis.has_exponent()) std::printf("  exponent %.4f", hypothesis.exponent());
    std::printf("\n");
  }
  std::printf("  %s: %s\n", result.verdict().c_str(), result.reason().c_str());
}

}  // namespace

absl::Status RunProbe(const ProbeRequest& request, bool json) {
  EYEBOX_ASSIGN_OR_RETURN(const v1::ProbeResult result, Probe(request));
  PrintWarnings(result.warnings());
  if (json) return PrintJson(result);
  if (result.verdict().empty()) {
    PrintPlan(result);
  } else {
    PrintVerdict(result);
  }
  return absl::OkStatus();
}

}  // namespace eyebox::service::cli
