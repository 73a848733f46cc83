// The noise model and the shares of the variance of a merged bracket.
#include <cmath>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "optics/reduce/variance_budget.h"
#include "optics/sensor/noise_model.h"
#include "tests/tools/numerics/worst_case.h"

namespace eyebox::numerics {
namespace {

constexpr ImageSize kOnePixel = {1, 1};
constexpr int kFrames = 4;

struct Bracket {
  optics::NoiseModel noise;
  double rate_dn_s = 0;
  std::vector<double> exposures_s;
};

// Terms of one exposure of a bracket in 50 digits, (DN/s)^2.
struct Terms50 {
  Digits50 photon, read, quantisation, dark, variance;
};

Terms50 TermsOf(const Bracket& bracket, double exposure_s, double expected_dn, double variance) {
  const Digits50 per_s2 = 1 / (Digits50(exposure_s) * exposure_s);
  Terms50 terms;
  terms.photon = Digits50(bracket.noise.gain_dn_per_e) * expected_dn / kFrames * per_s2;
  terms.read = Digits50(bracket.noise.read_variance_dn2) / kFrames * per_s2;
  terms.quantisation = Digits50(bracket.noise.quantisation_variance_dn2) / kFrames * per_s2;
  terms.variance = variance;
  terms.dark = terms.variance - terms.photon - terms.read - terms.quantisation;
  return terms;
}

void CompareShares(const Bracket& bracket, std::vector<WorstCase>& cases) {
  optics::VarianceBudgetMeter meter(bracket.noise, std::nullopt, kOnePixel);
  Terms50 sums = {0, 0, 0, 0, 0};
  Digits50 weight = 0;
  for (const double exposure_s : bracket.exposures_s) {
    optics::Stack light;
    light.setting = {exposure_s, 0};
    light.frames = kFrames;
    optics::DarkFrame dark;
    dark.image_dn.value = Image<float>(kOnePixel, static_cast<float>(bracket.noise.bias_dn));
    optics::MeasuredImage rate;
    rate.mask = Image<uint8_t>(kOnePixel, 0);
    const Image<float> expected(kOnePixel, static_cast<float>(bracket.rate_dn_s));
    const double expected_dn = expected.pixels()[0] * exposure_s;
    const double own = bracket.noise.MeanVariance(expected_dn, kFrames);
    rate.variance =
        Image<float>(kOnePixel, static_cast<float>(1.1 * own / (exposure_s * exposure_s)));
    meter.Add({&light, {std::shared_ptr<const optics::DarkFrame>(), &dark}, {}},
              optics::PixelsOf(rate), expected.pixels());
    const Terms50 terms = TermsOf(bracket, exposure_s, expected_dn, rate.variance.pixels()[0]);
    const Digits50 w = 1 / terms.variance;
    weight += w;
    sums.photon += w * w * terms.photon;
    sums.read += w * w * terms.read;
    sums.quantisation += w * w * terms.quantisation;
    sums.dark += w * w * terms.dark;
  }
  const optics::VarianceBudget mean = meter.Mean();
  const std::pair<double, Digits50> shares[] = {{mean.photon, sums.photon / weight},
                                                {mean.read, sums.read / weight},
                                                {mean.quantisation, sums.quantisation / weight},
                                                {mean.dark, sums.dark / weight}};
  for (const auto& [found, exact] : shares) {
    cases[0].Compare(
        found, exact,
        {{"rate DN/s", bracket.rate_dn_s}, {"shortest s", bracket.exposures_s.front()}});
  }
  cases[1].Compare(mean.photon + mean.read + mean.quantisation + mean.dark, 1,
                   {{"rate DN/s", bracket.rate_dn_s}});
}

}  // namespace

void AddVarianceRows(Density density, std::vector<Row>& rows) {
  WorstCase mean("NoiseModel::MeanVariance", 1e-15);
  std::vector<WorstCase> shares = {
      WorstCase("VarianceBudgetMeter, each share", 1e-14, Measure::kOfScale),
      WorstCase("VarianceBudgetMeter, sum of shares", 1e-14, Measure::kOfScale)};
  optics::NoiseModel noise;
  noise.gain_dn_per_e = 0.37;
  noise.read_variance_dn2 = 6.5;
  noise.bias_dn = 64;
  for (const double exposure_s : LogSteps(1e-6, 25, 9 * density.steps)) {
    for (const double dn : LogSteps(1e-3, 4000, 9 * density.steps)) {
      CompareShares({noise, dn / exposure_s, {exposure_s, 4 * exposure_s}}, shares);
      const Digits50 exact =
          (Digits50(noise.read_variance_dn2) + Digits50(noise.gain_dn_per_e) * dn) / kFrames +
          Digits50(noise.quantisation_variance_dn2) / kFrames;
      mean.Compare(noise.MeanVariance(dn, kFrames), exact, {{"excess DN", dn}});
    }
  }
  rows.push_back(mean.row());
  for (const WorstCase& share : shares) rows.push_back(share.row());
}

}  // namespace eyebox::numerics
