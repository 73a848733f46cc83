#include "fit/activation/level_design.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "capture/base/random.h"
#include "tests/fit/activation/simulated_series.h"

namespace eyebox::fit {
namespace {

constexpr int kDrives = 33;
const std::vector<double> kU = {0.05, 0.1, 0.2, 0.4, 0.7, 1};

ActivationFit FitOf(const Activation& truth, ActivationModel model) {
  const auto fit =
      FitActivation(SimulateSeries(truth, 17, 0.003), model, Weighting::kMeasuredSigma);
  EXPECT_TRUE(fit.ok()) << fit.status();
  return *fit;
}

// Photon noise, and a floor.
std::vector<LevelCandidate> Candidates(const Activation& truth) {
  std::vector<LevelCandidate> candidates;
  for (int i = 0; i < kDrives; ++i) {
    const double drive = i / (kDrives - 1.0);
    candidates.push_back({drive, std::sqrt(1e-4 * truth.Luminance(drive) + 1e-5), 0.1 + 0.01 * i});
  }
  return candidates;
}

std::vector<double> RandomShares(RandomStream& random) {
  std::vector<double> shares;
  for (int i = 0; i < kDrives; ++i) shares.push_back(random.Uniform());
  return shares;
}

class LevelDesignOf : public testing::TestWithParam<ErrorAtU> {};

TEST_P(LevelDesignOf, NoOtherSharesOfTheTimeAreBetter) {
  const Activation truth{.minimum_luminance = 0.2, .luminance_range = 59, .gamma = 2.3};
  const ActivationFit fit = FitOf(truth, ActivationModel::kPowerOffset);
  const auto candidates = Candidates(truth);
  const auto design = OptimalLevels(fit, GetParam(), candidates, kU);
  ASSERT_TRUE(design.ok()) << design.status();
  EXPECT_GE(design->efficiency, 0.99);
  EXPECT_LE(design->efficiency, 1);
  double sum = 0;
  for (const double share : design->shares) sum += share;
  EXPECT_NEAR(sum, 1, 1e-9);
  const auto own = VarianceTimes(fit, GetParam(), candidates, design->shares, kU);
  ASSERT_TRUE(own.ok());
  EXPECT_NEAR(*own / design->variance_s, 1, 1e-6);
  RandomStream random({7});
  for (int i = 0; i < 200; ++i) {
    std::vector<double> shares = RandomShares(random);
    // Half of them near the optimum, where a wrong one would be found out.
    if (i % 2 == 0) {
      for (int k = 0; k < kDrives; ++k) shares[k] = design->shares[k] + 0.02 * shares[k];
    }
    const auto other = VarianceTimes(fit, GetParam(), candidates, shares, kU);
    ASSERT_TRUE(other.ok());
    EXPECT_GE(*other, design->efficiency * *own);
  }
  const auto even =
      VarianceTimes(fit, GetParam(), candidates, std::vector<double>(kDrives, 1.0), kU);
  EXPECT_GT(*even, 1.3 * *own);
}

INSTANTIATE_TEST_SUITE_P(Errors, LevelDesignOf,
                         testing::Values(ErrorAtU::kLuminance, ErrorAtU::kDeparture));

TEST(LevelDesignCases, AStraightLineSeenAtItsEndIsMeasuredThere) {
  // Luminance at u = 1 is a parameter sum that the reading at drive 1 tells alone.
  const Activation truth{.minimum_luminance = 1, .luminance_range = 50, .gamma = 2.2};
  const ActivationFit fit = FitOf(truth, ActivationModel::kPowerOffset);
  const std::vector<double> white = {1};
  const auto design = OptimalLevels(fit, ErrorAtU::kLuminance, Candidates(truth), white);
  ASSERT_TRUE(design.ok()) << design.status();
  EXPECT_GT(design->shares.back(), 0.9);
}

TEST(LevelDesignCases, VariancesAreThoseOfRepeatedFits) {
  const Activation truth{.minimum_luminance = 0.2, .luminance_range = 59, .gamma = 2.3};
  constexpr int kTrials = 600;
  std::vector<double> departure(kU.size(), 0);
  std::vector<double> luminance(kU.size(), 0);
  ActivationFit stated;
  for (int trial = 0; trial < kTrials; ++trial) {
    const auto fit = FitActivation(SimulateSeries(truth, 9, 0.003, 100 + trial),
                                   ActivationModel::kPowerOffset, Weighting::kMeasuredSigma);
    ASSERT_TRUE(fit.ok());
    if (trial == 0) stated = *fit;
    const Activation& a = fit->activation;
    for (size_t i = 0; i < kU.size(); ++i) {
      const double drive =
          a.InverseH((kU[i] * a.Luminance(1) - a.minimum_luminance) / a.luminance_range);
      const double shown = truth.Luminance(drive);
      departure[i] += std::pow(shown / (kU[i] * truth.Luminance(1)) - 1, 2) / kTrials;
      luminance[i] += std::pow(shown / (kU[i] * a.Luminance(1)) - 1, 2) / kTrials;
    }
  }
  // The first fit's sigmas may be scaled by its chi-square; its drives are those of all.
  const double scale = std::max(stated.chi_square / stated.degrees_of_freedom, 1.0);
  const auto by_departure = ErrorVariances(stated, ErrorAtU::kDeparture, kU);
  const auto by_luminance = ErrorVariances(stated, ErrorAtU::kLuminance, kU);
  for (size_t i = 0; i < kU.size(); ++i) {
    if (kU[i] < 1) {
      EXPECT_NEAR(by_departure[i] / scale / departure[i], 1, 0.25) << kU[i];
    }
    EXPECT_NEAR(by_luminance[i] / scale / luminance[i], 1, 0.25) << kU[i];
  }
}

TEST(LevelDesignCases, CandidatesThatSayNothingAreRefused) {
  const Activation truth{.minimum_luminance = 0.2, .luminance_range = 59, .gamma = 2.3};
  const ActivationFit fit = FitOf(truth, ActivationModel::kPowerOffset);
  auto candidates = Candidates(truth);
  candidates[3].frame_sigma = 0;
  EXPECT_TRUE(
      absl::IsInvalidArgument(OptimalLevels(fit, ErrorAtU::kLuminance, candidates, kU).status()));
  const std::vector<LevelCandidate> one = {{1, 0.1, 0.1}};
  EXPECT_TRUE(
      absl::IsFailedPrecondition(OptimalLevels(fit, ErrorAtU::kLuminance, one, kU).status()));
}

}  // namespace
}  // namespace eyebox::fit
