#include "tests/tools/coverage/coverage_table.h"

#include <algorithm>
#include <cstdio>

namespace eyebox {

void CoverageRow::Add(const std::vector<double>& pulls) {
  if (pulls.empty()) return;
  double covered = 0;
  for (const double pull : pulls) {
    covered += std::abs(pull) <= kInterval ? 1.0 / static_cast<double>(pulls.size()) : 0;
    pull_sum += pull;
    pull_square += pull * pull;
  }
  samples += static_cast<double>(pulls.size());
  ++recordings;
  share += covered;
  share_square += covered * covered;
}

double CoverageRow::StandardError() const {
  const double spread = share_square / recordings - Mean() * Mean();
  const double binomial = 0.95 * 0.05 / samples;  // where all recordings cover alike
  return std::sqrt(std::max(spread / recordings, binomial));
}

bool PrintCoverage(const CoverageTable& table) {
  std::printf("%-44s  %9s  %6s  %9s  %8s  %11s\n", "95 % interval of", "covers", "+-", "mean pull",
              "rms pull", "none stated");
  bool sound = true;
  for (const auto& [name, row] : table) {
    if (row.recordings == 0) {
      std::printf("%-44s  %9s  %6s  %9s  %8s  %11d\n", name.c_str(), "-", "-", "-", "-",
                  row.without);
      continue;
    }
    const double error = row.StandardError();
    const bool holds = std::abs(row.Mean() - 0.95) <= 0.02 + 3 * error;
    sound = sound && holds;
    std::printf("%-44s  %7.1f %%  %4.1f %%  %9.2f  %8.2f  %11d%s\n", name.c_str(), 100 * row.Mean(),
                100 * error, row.pull_sum / row.samples, std::sqrt(row.pull_square / row.samples),
                row.without, holds ? "" : "  <- fails");
  }
  return sound;
}

}  // namespace eyebox
