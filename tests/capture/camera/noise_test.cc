#include "capture/camera/sim/noise.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace eyebox::capture {
namespace {

TEST(RandomStream, GivesTheSameNumbersOnEveryMachine) {
  // Worked out apart from this code, from the published definitions of SplitMix64 (whose first
  // output for seed 0 is e220a8397b1dcdaf) and xoshiro256**.
  EXPECT_EQ(MixBits(0), 0xe220a8397b1dcdaf);
  RandomStream stream({1, 2, 3});
  EXPECT_EQ(stream.Next(), 0x267a73ceee726977);
  EXPECT_EQ(stream.Next(), 0x87a0792eba92def9);
  EXPECT_EQ(stream.Next(), 0x61c1c193882b274d);
  EXPECT_EQ(stream.Next(), 0x278fdaa9f5b69692);
}

TEST(RandomStream, KeysOfAnotherOrderOrLengthGiveAnotherStream) {
  const uint64_t first = RandomStream({1, 2, 3}).Next();
  EXPECT_NE(first, RandomStream({1, 3, 2}).Next());
  EXPECT_NE(first, RandomStream({1, 2}).Next());
  EXPECT_NE(first, RandomStream({1, 2, 3, 0}).Next());
}

TEST(RandomStream, BelowCoversItsRangeEvenly) {
  RandomStream stream({7});
  std::vector<int> hits(6, 0);
  const int draws = 60000;
  for (int i = 0; i < draws; ++i) ++hits[stream.Below(6)];
  // Binomial: sigma = sqrt(60000 * 1/6 * 5/6) = 91.
  for (const int count : hits) EXPECT_NEAR(count, draws / 6, 4.5 * 91);
}

TEST(LogFactorial, AgreesWithTheGammaFunction) {
  for (double k = 0; k < 2e7; k = k < 30 ? k + 1 : std::floor(k * 1.7)) {
    const double expected = std::lgamma(k + 1);
    EXPECT_NEAR(LogFactorial(k), expected, 1e-10 + 4e-16 * expected) << k;
  }
}

TEST(Gaussian, FollowsTheNormalDistribution) {
  NoiseSource noise({11});
  std::vector<double> draws(200000);
  for (double& draw : draws) draw = noise.Gaussian();
  std::sort(draws.begin(), draws.end());
  double distance = 0;
  for (size_t i = 0; i < draws.size(); ++i) {
    const double expected = 0.5 * std::erfc(-draws[i] / std::numbers::sqrt2);
    const double n = static_cast<double>(draws.size());
    distance = std::max({distance, std::abs(static_cast<double>(i) / n - expected),
                         std::abs(static_cast<double>(i + 1) / n - expected)});
  }
  // Kolmogorov-Smirnov: 1.95 / sqrt(n) is exceeded once in a thousand.
  EXPECT_LT(distance, 1.95 / std::sqrt(static_cast<double>(draws.size())));
}

TEST(Gaussian, NeighbouringDrawsAreUncorrelated) {
  NoiseSource noise({12});
  const int draws = 200000;
  double product_sum = 0;
  double previous = noise.Gaussian();
  for (int i = 0; i < draws; ++i) {
    const double next = noise.Gaussian();
    product_sum += previous * next;
    previous = next;
  }
  EXPECT_NEAR(product_sum / draws, 0, 4.5 / std::sqrt(draws));
}

class PoissonOfMean : public testing::TestWithParam<double> {};

TEST_P(PoissonOfMean, HasMeanAndVarianceOfTheProcess) {
  const double mean = GetParam();
  NoiseSource noise({13, static_cast<uint64_t>(mean * 1000)});
  const int draws = 200000;
  double sum = 0;
  double squares = 0;
  for (int i = 0; i < draws; ++i) {
    const double departure = static_cast<double>(noise.Poisson(mean)) - mean;
    sum += departure;
    squares += departure * departure;
  }
  const double mean_sigma = std::sqrt(mean / draws);
  // The fourth central moment of a Poisson variate is mean + 3 mean^2.
  const double variance_sigma = std::sqrt((mean + 2 * mean * mean) / draws);
  EXPECT_NEAR(sum / draws, 0, 4.5 * mean_sigma);
  EXPECT_NEAR(squares / draws, mean, 4.5 * variance_sigma);
}

// Means so small that every outcome can be counted.
class PoissonOfSmallMean : public testing::TestWithParam<double> {};

TEST_P(PoissonOfSmallMean, FollowsTheProbabilitiesOfTheProcess) {
  const double mean = GetParam();
  NoiseSource noise({14, static_cast<uint64_t>(mean * 1000)});
  const int draws = 200000;
  std::vector<int> hits(static_cast<size_t>(mean + 12 * std::sqrt(mean) + 20), 0);
  for (int i = 0; i < draws; ++i) {
    const auto events = static_cast<size_t>(noise.Poisson(mean));
    ASSERT_LT(events, hits.size());
    ++hits[events];
  }
  double chi2 = 0;
  int cells = 0;
  for (size_t k = 0; k < hits.size(); ++k) {
    const double n = static_cast<double>(k);
    const double expected = draws * std::exp(n * std::log(mean) - mean - std::lgamma(n + 1));
    if (expected < 8) continue;
    chi2 += (hits[k] - expected) * (hits[k] - expected) / expected;
    ++cells;
  }
  // chi2 has about `cells` degrees of freedom; its standard deviation is sqrt(2 cells).
  EXPECT_GT(cells, 2);
  EXPECT_LT(chi2, cells + 4.5 * std::sqrt(2.0 * cells));
}

INSTANTIATE_TEST_SUITE_P(Means, PoissonOfMean,
                         testing::Values(0.4, 9.99, 10.0, 60.0, 800.0, 15000.0, 1.5e7));
INSTANTIATE_TEST_SUITE_P(Means, PoissonOfSmallMean,
                         testing::Values(0.4, 3.7, 9.99, 10.0, 14.2, 60.0, 800.0));

TEST(Poisson, NoLightGivesNoEvents) {
  NoiseSource noise({15});
  for (int i = 0; i < 100; ++i) EXPECT_EQ(noise.Poisson(0), 0);
}

}  // namespace
}  // namespace eyebox::capture
