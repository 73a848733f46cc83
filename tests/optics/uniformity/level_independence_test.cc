// The test keeps its size where g is the same at all levels, and finds where it is not.
#include "optics/uniformity/level_independence.h"

#include <gtest/gtest.h>

#include <boost/math/special_functions/gamma.hpp>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>
#include <random>

#include "optics/uniformity/chi_square.h"

namespace eyebox::optics {
namespace {

constexpr ImageSize kBlocks{12, 9};
constexpr double kDrives[] = {0, 0.25, 0.5, 0.75, 1};
constexpr double kRelativeSigma = 0.01;

double Luminance(double drive) { return 0.2 + 60 * std::pow(drive, 2.2); }

// `tilt`: of g along x at drive 0, gone at drive 1.
std::vector<LevelBlocks> Levels(double tilt, uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::vector<LevelBlocks> levels;
  for (const double drive : kDrives) {
    LevelBlocks level{drive, MakeMeasuredImage(kBlocks, "cd/m2")};
    for (int y = 0; y < kBlocks.height_px; ++y) {
      for (int x = 0; x < kBlocks.width_px; ++x) {
        const double u = 2.0 * x / (kBlocks.width_px - 1) - 1;
        const double g = 1 - 0.2 * u * u + 0.01 * y + tilt * (1 - drive) * u;
        const double sigma = kRelativeSigma * Luminance(drive) + 0.002;
        level.blocks.value.at(x, y) =
            static_cast<float>(Luminance(drive) * g + sigma * normal(random));
        level.blocks.variance.at(x, y) = static_cast<float>(sigma * sigma);
      }
    }
    levels.push_back(level);
  }
  return levels;
}

TEST(LevelIndependence, KeepsItsSizeWhereGIsShared) {
  constexpr int kTrials = 400;
  int rejected = 0;
  double failing = 0;
  for (uint64_t seed = 1; seed <= kTrials; ++seed) {
    const auto test = TestLevelIndependence(Levels(0, seed));
    ASSERT_TRUE(test.ok()) << test.status();
    EXPECT_EQ(test->degrees_of_freedom, 4 * 107);
    rejected += test->p_value < 0.05 ? 1 : 0;
    failing += test->failing_share / kTrials;
  }
  EXPECT_NEAR(rejected, 0.05 * kTrials, 3.5 * std::sqrt(0.05 * 0.95 * kTrials));
  EXPECT_NEAR(failing, 0.05, 0.01);
}

TEST(LevelIndependence, FindsAGThatTiltsInTheDark) {
  const auto test = TestLevelIndependence(Levels(0.08, 1));
  ASSERT_TRUE(test.ok()) << test.status();
  EXPECT_LT(test->p_value, 1e-6);
  EXPECT_GT(test->failing_share, 0.3);
  // The tilt's extremes fail, the middle column does not.
  EXPECT_LT(test->block_p_value.at(0, 4), 0.01);
  EXPECT_GT(test->levels.front().excess_relative, test->levels[2].excess_relative);
}

TEST(LevelIndependence, LuminancesAndTheSharedGComeOut) {
  const auto test = TestLevelIndependence(Levels(0, 7));
  ASSERT_TRUE(test.ok()) << test.status();
  EXPECT_NEAR(test->levels.back().luminance / test->levels[2].luminance,
              Luminance(1) / Luminance(0.5), 0.01);
  EXPECT_NEAR(test->g.at(11, 0) / test->g.at(6, 0), (1 - 0.2) / (1 - 0.2 / 121), 0.03);
}

TEST(LevelIndependence, NeedsTwoLitLevelsOfOneSize) {
  auto levels = Levels(0, 1);
  levels.resize(1);
  EXPECT_TRUE(absl::IsFailedPrecondition(TestLevelIndependence(levels).status()));
  levels = Levels(0, 1);
  levels.back().blocks = MakeMeasuredImage({3, 3}, "cd/m2");
  EXPECT_TRUE(absl::IsInvalidArgument(TestLevelIndependence(levels).status()));
  levels = Levels(0, 1);
  for (LevelBlocks& level : levels) {
    for (uint8_t& flag : level.blocks.mask.pixels()) flag = kSaturated;
    BlankMaskedPixels(level.blocks);
  }
  EXPECT_TRUE(absl::IsFailedPrecondition(TestLevelIndependence(levels).status()));
}

TEST(ChiSquareSurvival, AgreesWithFiftyDigits) {
  using Exact = boost::multiprecision::cpp_bin_float_50;
  for (const double freedom : {0.5, 1.0, 2.0, 7.0, 40.0, 428.0, 2e4}) {
    for (const double ratio : {0.01, 0.3, 0.9, 1.0, 1.1, 1.5, 3.0}) {
      const double chi2 = freedom * ratio;
      const auto exact =
          static_cast<double>(boost::math::gamma_q(Exact(freedom) / 2, Exact(chi2) / 2));
      if (exact < 1e-280) continue;
      EXPECT_NEAR(ChiSquareSurvival(chi2, freedom) / exact, 1, 2e-12) << freedom << " " << ratio;
    }
  }
  EXPECT_EQ(ChiSquareSurvival(0, 3), 1);
  EXPECT_EQ(ChiSquareSurvival(HUGE_VAL, 3), 0);
  EXPECT_TRUE(std::isnan(ChiSquareSurvival(1, 0)));
}

}  // namespace
}  // namespace eyebox::optics
