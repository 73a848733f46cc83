#include "optics/scatter/contrast.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "optics/scatter/correct_scatter.h"
#include "optics/scatter/spread_light.h"
#include "tests/optics/scatter/luminance_images.h"

namespace eyebox::optics {
namespace {

constexpr Checkerboard kBoard{{-0.5, -0.5}, 40, 6, 6};
constexpr ImageSize kSize{240, 240};
constexpr double kPitchDeg = 0.1;
const ScatterKernel kLens{.core_radius_deg = 0.05, .tail_share = 0.05, .tail_radius_deg = 2};

LuminanceImage Even(double luminance, double sigma, uint64_t seed) {
  return WithNoise(Image<float>({50, 50}, static_cast<float>(luminance)), sigma, 0, seed);
}

Image<float> Board(double bright, double dark) {
  Image<float> board = DrawCheckerboard(kSize, kBoard);
  for (float& v : board.pixels()) v = static_cast<float>(dark + v * (bright - dark));
  return board;
}

TEST(ContrastTest, FullFieldsGiveTheirRatio) {
  const auto figure = FullFieldContrast(Even(100, 0.5, 1), Even(0.1, 0.01, 2), {{25, 25}, 15});
  ASSERT_TRUE(figure.ok()) << figure.status();
  EXPECT_NEAR(figure->contrast, 1000, 3 * figure->sigma);
  EXPECT_GT(figure->sigma, 2);
  EXPECT_LT(figure->sigma, 6);
  EXPECT_FALSE(figure->only_lower_bound);
  EXPECT_GT(figure->limit, 1e4);
}

TEST(ContrastTest, BlackWithinItsNoiseGivesALowerBound) {
  const auto figure = FullFieldContrast(Even(100, 0.5, 1), Even(0, 0.01, 2), {{25, 25}, 15});
  ASSERT_TRUE(figure.ok());
  EXPECT_TRUE(figure->only_lower_bound);
  EXPECT_GT(figure->contrast, 3e4);
  EXPECT_TRUE(std::isfinite(figure->contrast));
}

TEST(ContrastTest, WhiteWithinItsNoiseIsRejected) {
  EXPECT_EQ(FullFieldContrast(Even(0, 1, 1), Even(0, 1, 2), {{25, 25}, 15}).status().code(),
            absl::StatusCode::kFailedPrecondition);
}

TEST(ContrastTest, InstrumentLimitsTheCheckerboard) {
  const auto seen = SpreadLight(Board(100, 0), kPitchDeg, kLens);
  ASSERT_TRUE(seen.ok());
  const LuminanceImage image = WithNoise(*seen, 0.01, 0, 3);
  const auto figure = CheckerboardContrast(image, kBoard, InstrumentGlare{kLens, kPitchDeg});
  ASSERT_TRUE(figure.ok()) << figure.status();
  // A display of infinite contrast shows just what the instrument lets it.
  EXPECT_NEAR(figure->contrast / figure->limit, 1, 0.01);
  EXPECT_LT(figure->limit, 100);
}

TEST(ContrastTest, CorrectedCheckerboardShowsTheDisplay) {
  const auto seen = SpreadLight(Board(100, 0.5), kPitchDeg, kLens);
  ASSERT_TRUE(seen.ok());
  auto corrector = ScatterCorrector::Create(kLens, kSize, kPitchDeg);
  ASSERT_TRUE(corrector.ok());
  const auto corrected = corrector->Correct(WithNoise(*seen, 0.01, 0, 3));
  ASSERT_TRUE(corrected.ok());
  const auto figure = CheckerboardContrast(corrected->luminance, kBoard, std::nullopt);
  ASSERT_TRUE(figure.ok());
  EXPECT_NEAR(figure->contrast, 200, 2);
}

TEST(ContrastTest, BoardMustLieInTheImage) {
  const LuminanceImage image = Even(1, 0.1, 1);
  EXPECT_FALSE(CheckerboardContrast(image, kBoard, std::nullopt).ok());
  EXPECT_FALSE(CheckerboardContrast(image, {{0, 0}, 10, 1, 1}, std::nullopt).ok());
  EXPECT_FALSE(CheckerboardContrast(image, {{0, 0}, 10, 2, 2, true, 2}, std::nullopt).ok());
}

TEST(GlareTest, BlackSpotOnABrightFieldIsFilledByTheInstrument) {
  constexpr int kMiddle = 120;
  Image<float> spot(kSize), field(kSize);
  for (int y = 0; y < 240; ++y) {
    for (int x = 0; x < 240; ++x) {
      const double radius = std::hypot(x - kMiddle, y - kMiddle) * kPitchDeg;
      field.at(x, y) = radius < 11 ? 80.0F : 0.0F;
      spot.at(x, y) = radius < 1.5 ? 0.0F : field.at(x, y);
    }
  }
  const auto seen_spot = SpreadLight(spot, kPitchDeg, kLens);
  const auto seen_field = SpreadLight(field, kPitchDeg, kLens);
  ASSERT_TRUE(seen_spot.ok() && seen_field.ok());
  const auto figure =
      BlackSpotGlare(WithNoise(*seen_spot, 0.01, 0, 5), WithNoise(*seen_field, 0.01, 0, 6),
                     {{{kMiddle, kMiddle}, 3}, 3, 11}, kLens);
  ASSERT_TRUE(figure.ok()) << figure.status();
  EXPECT_GT(figure->share, 0.01);
  EXPECT_NEAR(figure->share / figure->instrument_share, 1, 0.03);
  EXPECT_GT(figure->floor, figure->instrument_share);
}

}  // namespace
}  // namespace eyebox::optics
