#include "optics/scatter/correct_scatter.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <vector>

#include "optics/scatter/contrast.h"
#include "optics/scatter/spread_light.h"
#include "tests/optics/scatter/luminance_images.h"

namespace eyebox::optics {
namespace {

using ::testing::HasSubstr;
constexpr double kPitchDeg = 0.1;

ScatterKernel Lens(double tail_share) {
  return {.core_radius_deg = 0.1,
          .tail_share = tail_share,
          .tail_radius_deg = 1.5,
          .tail_exponent = 2.6,
          .pedestal_share = tail_share / 20,
          .reach_deg = 40};
}

Image<float> Board(int size_px, double bright, double dark, int squares) {
  const double side = static_cast<double>(size_px) / squares;
  Image<float> board = DrawCheckerboard({size_px, size_px}, {{-0.5, -0.5}, side, squares, squares});
  for (float& v : board.pixels()) v = static_cast<float>(dark + v * (bright - dark));
  return board;
}

double Sum(const Image<float>& image) {
  return std::accumulate(image.pixels().begin(), image.pixels().end(), 0.0);
}

ScatterCorrection Correct(const LuminanceImage& reading, const ScatterKernel& kernel,
                          const CorrectionOptions& options = {}) {
  auto corrector = ScatterCorrector::Create(kernel, reading.image.size(), kPitchDeg, options);
  EXPECT_TRUE(corrector.ok()) << corrector.status();
  auto correction = corrector->Correct(reading);
  EXPECT_TRUE(correction.ok()) << correction.status();
  return *std::move(correction);
}

struct FloorTest {
  size_t above = 0;         // pixels in the middle of dark squares that lie above the floor
  size_t good = 0;          // of them, within 5 % of the truth
  double worst_square = 0;  // relative error of the mean of a dark square
};

FloorTest TestDarkSquares(const ScatterCorrection& correction, double dark, int squares) {
  FloorTest result;
  const Image<float>& value = correction.luminance.image.value;
  const int side = value.size().width_px / squares;
  for (int row = 0; row < squares; ++row) {
    for (int column = 1 - row % 2; column < squares; column += 2) {
      double sum = 0;
      int pixels = 0;
      for (int y = row * side + side / 4; y < (row + 1) * side - side / 4; ++y) {
        for (int x = column * side + side / 4; x < (column + 1) * side - side / 4; ++x) {
          sum += value.at(x, y);
          ++pixels;
          if (!(value.at(x, y) > correction.floor.at(x, y))) continue;
          ++result.above;
          if (std::abs(value.at(x, y) / dark - 1) < 0.05) ++result.good;
        }
      }
      const double error = sum / pixels / dark - 1;
      result.worst_square = std::max(result.worst_square, std::abs(error));
    }
  }
  return result;
}

class CheckerboardTest : public ::testing::TestWithParam<double> {};

TEST_P(CheckerboardTest, DarkSquaresComeBackWhereverAboveTheFloor) {
  for (const int size : {160, 480}) {  // full resolution, and in blocks at the edges
    for (const double dark : {0.05, 0.5, 5.0}) {
      const auto seen = SpreadLight(Board(size, 100, dark, 4), kPitchDeg, Lens(GetParam()));
      ASSERT_TRUE(seen.ok());
      const ScatterCorrection correction =
          Correct(WithNoise(*seen, 2e-3, 1e-6, 11), Lens(GetParam()));
      const FloorTest test = TestDarkSquares(correction, dark, 4);
      if (dark >= 0.5) {
        EXPECT_GT(test.above, 3 * size * size / 32) << size << " px, " << dark;
        EXPECT_LT(test.worst_square, 0.05) << size << " px, " << dark;
      }
      EXPECT_GE(static_cast<double>(test.good), 0.95 * static_cast<double>(test.above))
          << size << " px, " << dark;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(TailShares, CheckerboardTest,
                         ::testing::Values(0.001, 0.01, 0.05, 0.1, 0.3));

TEST(CorrectScatterTest, UncorrectedSquaresAreFarOff) {
  const auto seen = SpreadLight(Board(160, 100, 0.5, 4), kPitchDeg, Lens(0.1));
  ASSERT_TRUE(seen.ok());
  EXPECT_GT(seen->at(60, 20), 1.5);
}

// A kernel that is off by its stated uncertainty shifts dark squares by less than the floor says.
TEST(CorrectScatterTest, FloorCountsTheUncertaintyOfTheKernel) {
  const auto seen = SpreadLight(Board(160, 100, 0.3, 4), kPitchDeg, Lens(0.1));
  ASSERT_TRUE(seen.ok());
  const LuminanceImage reading = WithNoise(*seen, 1e-4, 0, 4);
  const ScatterCorrection trusting = Correct(reading, Lens(0.102));
  const ScatterCorrection knowing = Correct(reading, Lens(0.102), {.glare_relative_sigma = 0.02});
  EXPECT_LT(TestDarkSquares(trusting, 0.3, 4).good, TestDarkSquares(trusting, 0.3, 4).above);
  EXPECT_EQ(TestDarkSquares(knowing, 0.3, 4).above, 0);
  EXPECT_GT(knowing.below_floor_share, 0.4);
}

TEST(CorrectScatterTest, EnergyIsConserved) {
  for (const double tail : {0.0, 0.001, 0.3}) {
    for (const int size : {120, 500}) {
      Image<float> scene({size, size});
      for (int y = size / 3; y < size / 2; ++y) {
        for (int x = size / 3; x < size / 2; ++x) scene.at(x, y) = 70;
      }
      ScatterKernel kernel = Lens(tail);
      kernel.reach_deg = kPitchDeg * size / 4;  // nothing leaves the image
      const auto seen = SpreadLight(scene, kPitchDeg, kernel);
      ASSERT_TRUE(seen.ok());
      const ScatterCorrection correction = Correct(WithNoise(*seen, 1e-3, 0, 8), kernel);
      EXPECT_NEAR(correction.light_after / correction.light_before, 1, 1e-4) << tail;
      EXPECT_NEAR(correction.light_after / Sum(scene), 1, 1e-4) << tail;
    }
  }
}

// A bright field to the very edge: much of its light falls outside and must be made up for.
TEST(CorrectScatterTest, LightLostAcrossTheEdgeComesBack) {
  for (const int size : {100, 600}) {
    const Image<float> scene({size, size}, 40.0F);
    const auto seen = SpreadLight(scene, kPitchDeg, Lens(0.3));
    ASSERT_TRUE(seen.ok());
    EXPECT_LT(Sum(*seen), 0.97 * Sum(scene));
    const ScatterCorrection correction = Correct(WithNoise(*seen, 1e-3, 0, 9), Lens(0.3));
    for (int y = 8; y < size - 8; ++y) {
      for (int x = 8; x < size - 8; ++x) {
        ASSERT_NEAR(correction.luminance.image.value.at(x, y), 40, 0.4)
            << size << ": " << x << ", " << y;
      }
    }
  }
}

TEST(CorrectScatterTest, CoreIsDeconvolvedAsFarAsNoiseAllows) {
  const Image<float> scene = Board(128, 100, 10, 4);
  ScatterKernel kernel = Lens(0.05);
  const auto seen = SpreadLight(scene, kPitchDeg, kernel);
  ASSERT_TRUE(seen.ok());
  const auto rms = [&](const Image<float>& image) {
    double squares = 0;
    for (int y = 16; y < 112; ++y) {
      for (int x = 16; x < 112; ++x) squares += std::pow(image.at(x, y) - scene.at(x, y), 2);
    }
    return std::sqrt(squares / (96 * 96));
  };
  double before = 0;
  for (const double sigma : {0.01, 0.1, 1.0}) {
    const LuminanceImage reading = WithNoise(*seen, sigma, 0, 12);
    const ScatterCorrection sharp = Correct(reading, kernel, {.keep_core = false});
    const ScatterCorrection kept = Correct(reading, kernel);
    EXPECT_LT(rms(sharp.luminance.image.value), rms(kept.luminance.image.value)) << sigma;
    EXPECT_GT(rms(sharp.luminance.image.value), before) << sigma;
    EXPECT_GT(sharp.noise_gain, kept.noise_gain);
    before = rms(sharp.luminance.image.value);
  }
}

TEST(CorrectScatterTest, VarianceIsThatOfRepeats) {
  const Image<float> scene = Board(96, 100, 1, 3);
  const ScatterKernel kernel = Lens(0.2);
  const auto seen = SpreadLight(scene, kPitchDeg, kernel);
  ASSERT_TRUE(seen.ok());
  auto corrector = ScatterCorrector::Create(kernel, scene.size(), kPitchDeg);
  ASSERT_TRUE(corrector.ok());
  constexpr int kRepeats = 200;
  std::vector<double> sum(96 * 96), squares(96 * 96), stated(96 * 96);
  for (int k = 0; k < kRepeats; ++k) {
    const auto correction = corrector->Correct(WithNoise(*seen, 0.05, 1e-3, 100 + k));
    ASSERT_TRUE(correction.ok());
    for (size_t i = 0; i < sum.size(); ++i) {
      const double value = correction->luminance.image.value.pixels()[i];
      sum[i] += value;
      squares[i] += value * value;
      stated[i] += correction->luminance.image.variance.pixels()[i] / kRepeats;
    }
  }
  // In the middle of bright and dark squares, over all their pixels.
  for (const auto& [column, row] : {std::pair{0, 0}, {1, 0}, {1, 1}, {2, 1}}) {
    double found = 0, claimed = 0;
    for (int y = row * 32 + 8; y < row * 32 + 24; ++y) {
      for (int x = column * 32 + 8; x < column * 32 + 24; ++x) {
        const size_t i = static_cast<size_t>(y) * 96 + x;
        found += (squares[i] - sum[i] * sum[i] / kRepeats) / (kRepeats - 1);
        claimed += stated[i];
      }
    }
    EXPECT_NEAR(found / claimed, 1, 0.1) << column << ", " << row;
  }
}

TEST(CorrectScatterTest, MaskedPixelsStayMaskedAndHarmNoNeighbour) {
  const Image<float> scene = Board(128, 100, 10, 4);
  const auto seen = SpreadLight(scene, kPitchDeg, Lens(0.1));
  ASSERT_TRUE(seen.ok());
  LuminanceImage reading = WithNoise(*seen, 0.01, 0, 5);
  for (const auto& [x, y] : {std::pair{16, 16}, {48, 16}, {80, 80}}) {
    reading.image.mask.at(x, y) = kDefective;
  }
  for (int y = 100; y < 110; ++y) {
    for (int x = 100; x < 110; ++x) reading.image.mask.at(x, y) = kSaturated;
  }
  BlankMaskedPixels(reading.image);
  const ScatterCorrection correction = Correct(reading, Lens(0.1));
  EXPECT_EQ(CountFlagged(correction.luminance.image, kDefective), 3);
  EXPECT_EQ(CountFlagged(correction.luminance.image, kSaturated), 100);
  EXPECT_TRUE(std::isnan(correction.luminance.image.value.at(16, 16)));
  EXPECT_TRUE(std::isnan(correction.floor.at(16, 16)));
  EXPECT_NEAR(correction.luminance.image.value.at(18, 16), 100, 1);
  EXPECT_NEAR(correction.luminance.image.value.at(50, 16), 10, 0.2);
  // Glare from what was guessed raises the floor nearby.
  EXPECT_GT(correction.floor.at(112, 105), 2 * correction.floor.at(20, 105));
}

TEST(CorrectScatterTest, WithoutTailNothingChanges) {
  const ScatterKernel sharp{.core_radius_deg = 1e-3};
  const LuminanceImage reading = WithNoise(Board(64, 100, 1, 4), 0.1, 0, 6);
  const ScatterCorrection correction = Correct(reading, sharp);
  for (size_t i = 0; i < 64 * 64; ++i) {
    ASSERT_NEAR(correction.luminance.image.value.pixels()[i], reading.image.value.pixels()[i],
                1e-3);
  }
  EXPECT_NEAR(correction.noise_gain, 1, 1e-4);
}

TEST(CorrectScatterTest, ExtremesAreFinite) {
  for (const double luminance : {1e-4, 1.0, 1e5}) {
    for (const ImageSize size : {ImageSize{1, 1}, {1, 7}, {2, 2}, {300, 1}}) {
      for (const double sigma : {0.0, 1e-2}) {
        const LuminanceImage reading =
            WithNoise(Image<float>(size, static_cast<float>(luminance)), sigma * luminance, 0, 1);
        const ScatterCorrection correction = Correct(reading, Lens(0.3));
        for (size_t i = 0; i < size.PixelCount(); ++i) {
          EXPECT_TRUE(std::isfinite(correction.luminance.image.value.pixels()[i]));
          EXPECT_TRUE(std::isfinite(correction.luminance.image.variance.pixels()[i]));
          EXPECT_TRUE(std::isfinite(correction.floor.pixels()[i]));
        }
        EXPECT_GT(correction.light_after, 0.5 * luminance * static_cast<double>(size.PixelCount()));
      }
    }
  }
}

TEST(CorrectScatterTest, AllMaskedComesBackAllMasked) {
  LuminanceImage reading = WithNoise(Image<float>({9, 9}, 1.0F), 0.1, 0, 1);
  for (uint8_t& mask : reading.image.mask.pixels()) mask = kSaturated;
  BlankMaskedPixels(reading.image);
  const ScatterCorrection correction = Correct(reading, Lens(0.3));
  EXPECT_EQ(CountFlagged(correction.luminance.image, kSaturated), 81);
  EXPECT_EQ(correction.light_after, 0);
}

TEST(CorrectScatterTest, BadPixelsAndSizesAreRefused) {
  auto corrector = ScatterCorrector::Create(Lens(0.1), {8, 8}, kPitchDeg);
  ASSERT_TRUE(corrector.ok());
  LuminanceImage reading = WithNoise(Image<float>({8, 8}, 1.0F), 0.1, 0, 1);
  reading.image.value.at(3, 2) = kNoValue;
  const auto correction = corrector->Correct(reading);
  EXPECT_EQ(correction.status().code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(std::string(correction.status().message()), HasSubstr("pixel (3, 2)"));
  reading.image.value.at(3, 2) = 1;
  reading.image.variance.at(4, 4) = -1;
  EXPECT_FALSE(corrector->Correct(reading).ok());
  EXPECT_FALSE(corrector->Correct(WithNoise(Image<float>({8, 7}), 0.1, 0, 1)).ok());
  EXPECT_FALSE(ScatterCorrector::Create(Lens(0.1), {8, 8}, 0).ok());
  EXPECT_FALSE(ScatterCorrector::Create(Lens(0.1), {0, 8}, 0.1).ok());
  EXPECT_FALSE(ScatterCorrector::Create(Lens(0.1), {8, 8}, 0.1, {.floor_tolerance = 0}).ok());
}

}  // namespace
}  // namespace eyebox::optics
