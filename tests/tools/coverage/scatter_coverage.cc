// How often the stated 95 % interval of each parameter of w covers the truth, over simulated glare
// series. Prints a table; `scatter_coverage [SERIES]`, 200 unless given. Exit 1 if a parameter lies
// further from 95 % than such a count does by chance (3 standard deviations).
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "tests/fit/scatter/simulated_glare.h"

namespace eyebox::fit {
namespace {

constexpr double kInterval = 1.959964;  // standard deviations on either side
constexpr double kTailShares[] = {0.001, 0.01, 0.1, 0.3};

struct Coverage {
  std::array<int, kGlareParameters> covered{};
  std::array<double, kGlareParameters> pull_squares{};
  int fits = 0;
};

Coverage Measure(double tail_share, int series, uint64_t first_seed) {
  const optics::ScatterKernel truth{.core_radius_deg = 0.06,
                                    .tail_share = tail_share,
                                    .tail_radius_deg = 0.7,
                                    .tail_exponent = 2.8};
  const auto expected = TruthOf(truth, {});
  Coverage coverage;
  for (int k = 0; k < series; ++k) {
    const auto fit = FitScatter(SimulateGlare(truth, {}, first_seed + static_cast<uint64_t>(k)));
    if (!fit.ok()) {
      std::printf("series %d: %s\n", k, std::string(fit.status().message()).c_str());
      continue;
    }
    ++coverage.fits;
    for (int i = 0; i < kGlareParameters; ++i) {
      const Parameter& parameter = fit->parameters[i];
      if (parameter.sigma == 0) continue;  // held
      const double pull = (parameter.value - expected[i]) / parameter.sigma;
      coverage.covered[i] += std::abs(pull) <= kInterval ? 1 : 0;
      coverage.pull_squares[i] += pull * pull;
    }
  }
  return coverage;
}

bool Print(double tail_share, const Coverage& coverage, int series) {
  static constexpr std::array<const char*, kGlareParameters> kNames = {
      "core_radius_deg", "tail_share",       "tail_radius_deg",     "tail_exponent",
      "pedestal_share",  "bright_luminance", "background_luminance"};
  bool sound = coverage.fits == series;
  const double chance = 3 * std::sqrt(0.95 * 0.05 / series);
  for (int i = 0; i < kGlareParameters; ++i) {
    if (coverage.pull_squares[i] == 0) continue;
    const double share = static_cast<double>(coverage.covered[i]) / coverage.fits;
    const double pull_rms = std::sqrt(coverage.pull_squares[i] / coverage.fits);
    sound = sound && std::abs(share - 0.95) <= chance;
    std::printf("%10.3f  %-20s  %6.1f %%  %8.2f  %5d\n", tail_share, kNames[i], 100 * share,
                pull_rms, coverage.fits);
  }
  return sound;
}

}  // namespace
}  // namespace eyebox::fit

int main(int argc, char** argv) {
  const int series = argc > 1 ? std::atoi(argv[1]) : 200;
  if (series < 1) {
    std::fprintf(stderr, "scatter_coverage: give a number of series above 0\n");
    return 2;
  }
  std::printf("tail share  parameter             covered  rms pull   fits\n");
  bool sound = true;
  uint64_t first_seed = 1'000'000;
  for (const double share : eyebox::fit::kTailShares) {
    const auto coverage = eyebox::fit::Measure(share, series, first_seed);
    sound = eyebox::fit::Print(share, coverage, series) && sound;
    first_seed += 1'000'000;  // other noise for each share
  }
  return sound ? 0 : 1;
}
