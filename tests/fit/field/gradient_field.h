// Fields whose exponent runs from one side to the other, and how often the F test rejects.
#ifndef EYEBOX_TESTS_FIT_FIELD_GRADIENT_FIELD_H_
#define EYEBOX_TESTS_FIT_FIELD_GRADIENT_FIELD_H_

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "capture/base/random.h"
#include "fit/field/exponent_by_region.h"

namespace eyebox::fit {

struct GradientTruth {
  size_t locations = 36;  // in a row, from left to right
  size_t levels = 9;
  int regions = 3;
  double gamma = 2.2;
  double relative_gradient = 0;  // of the exponent, from one end to the other
  double relative_sigma = 0.01;  // Gaussian, a share of each luminance
  double masked_share = 0;       // of readings that are not valid
  double cutoff = 0;
  uint64_t seed = 1;
};

struct GradientField {
  std::vector<double> drives;
  std::vector<float> luminance;
  std::vector<uint8_t> valid;
  std::vector<int> regions;
  MaskedStack Stack() const { return {drives, luminance, valid}; }
};

// Gains from 50 to 150, offsets from 0.2 to 1 cd/m2.
inline GradientField SimulateGradient(const GradientTruth& truth) {
  GradientField field;
  RandomStream random({truth.seed});
  const auto uniform = [&] { return random.Uniform(); };
  std::vector<double> gains, offsets, gammas;
  for (size_t i = 0; i < truth.locations; ++i) {
    const double place = (static_cast<double>(i) + 0.5) / static_cast<double>(truth.locations);
    gains.push_back(50 + 100 * uniform());
    offsets.push_back(0.2 + 0.8 * uniform());
    gammas.push_back(truth.gamma * (1 + truth.relative_gradient * (place - 0.5)));
    field.regions.push_back(static_cast<int>(place * truth.regions));
  }
  for (size_t level = 0; level < truth.levels; ++level) {
    const double drive = static_cast<double>(level) / static_cast<double>(truth.levels - 1);
    field.drives.push_back(drive);
    const double base = std::max(drive - truth.cutoff, 0.0) / (1 - truth.cutoff);
    for (size_t i = 0; i < truth.locations; ++i) {
      const double gaussian =
          std::sqrt(-2 * std::log(uniform())) * std::cos(6.283185307179586 * uniform());
      const double luminance = gains[i] * std::pow(base, gammas[i]) + offsets[i];
      field.luminance.push_back(
          static_cast<float>(luminance * (1 + truth.relative_sigma * gaussian)));
      field.valid.push_back(uniform() >= truth.masked_share ? 1 : 0);
    }
  }
  return field;
}

// Share of `replicates` fields in which the F test rejects one exponent at kSignificance.
inline double RejectedShare(GradientTruth truth, int replicates,
                            const SharedExponentOptions& options = {}) {
  int rejected = 0;
  for (int i = 0; i < replicates; ++i) {
    ++truth.seed;
    const GradientField field = SimulateGradient(truth);
    const auto weights = RelativeFieldWeights(field.Stack());
    EXPECT_TRUE(weights.ok()) << weights.status();
    const auto compared = CompareRegions(field.Stack(), *weights, field.regions, options);
    EXPECT_TRUE(compared.ok()) << compared.status();
    if (!compared.ok()) return -1;
    rejected += compared->p_value < kSignificance ? 1 : 0;
  }
  return static_cast<double>(rejected) / replicates;
}

}  // namespace eyebox::fit

#endif  // EYEBOX_TESTS_FIT_FIELD_GRADIENT_FIELD_H_
