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

TEST(ContrastTest, ABoardAroundTheAxisHoldsWholeSquaresOnBothSides) {
  const auto board = CheckerboardAround({160, 120}, {79.5, 55.5}, 25);
  ASSERT_TRUE(board.ok()) << board.status();
  EXPECT_EQ(board->columns, 6);
  EXPECT_EQ(board->rows, 4);
  EXPECT_EQ(board->corner.x_px, 4.5);
  EXPECT_EQ(board->corner.y_px, 5.5);
  const Image<float> drawn = DrawCheckerboard({160, 120}, *board);
  EXPECT_EQ(drawn.at(79, 55), 1) << "above the axis to the left";
  EXPECT_EQ(drawn.at(80, 55), 0);
  EXPECT_EQ(drawn.at(80, 56), 1);
  EXPECT_TRUE(
      absl::IsFailedPrecondition(CheckerboardAround({160, 120}, {79.5, 55.5}, 60).status()));
  EXPECT_TRUE(absl::IsInvalidArgument(CheckerboardAround({160, 120}, {79.5, 55.5}, 0).status()));
}

// What lies beside the image scatters into it: the board of a display that goes on is darker in no
// square, and the limit that the instrument sets is that of the squares which were measured.
TEST(ContrastTest, SquaresBesideTheImageLowerTheLimit) {
  Checkerboard board = *CheckerboardAround(kSize, {119.5, 119.5}, 40);
  const InstrumentGlare instrument{kLens, kPitchDeg};
  const LuminanceImage seen = WithNoise(Board(100, 0.1), 0.01, 0, 7);
  const auto goes_on = CheckerboardContrast(seen, board, instrument);
  board.continued = false;
  const auto ends = CheckerboardContrast(seen, board, instrument);
  ASSERT_TRUE(goes_on.ok() && ends.ok());
  EXPECT_LT(goes_on->limit, ends->limit);
  Image<float> wide({480, 480});
  for (int y = 0; y < 480; ++y) {
    for (int x = 0; x < 480; ++x) wide.at(x, y) = ((x / 40 + y / 40) % 2 == 0) ? 1.0F : 0.0F;
  }
  const auto spread = SpreadLight(wide, kPitchDeg, kLens);
  ASSERT_TRUE(spread.ok());
  LuminanceImage middle = WithNoise(Image<float>(kSize), 0, 0, 8);
  for (int y = 0; y < 240; ++y) {
    for (int x = 0; x < 240; ++x) middle.image.value.at(x, y) = spread->at(x + 120, y + 120);
  }
  const auto truth = CheckerboardContrast(middle, board, std::nullopt);
  ASSERT_TRUE(truth.ok());
  EXPECT_NEAR(goes_on->limit / truth->contrast, 1, 0.05);
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
