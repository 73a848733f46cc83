#include "service/report/raster.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "service/report/colour_map.h"

namespace eyebox::service::report {
namespace {

constexpr float kInvalid = std::numeric_limits<float>::quiet_NaN();

Image<float> HorizontalRamp(ImageSize size) {
  Image<float> map(size);
  for (int y = 0; y < size.height_px; ++y) {
    for (int x = 0; x < size.width_px; ++x) map.at(x, y) = static_cast<float>(x);
  }
  return map;
}

TEST(RasterTest, BlocksAverageTheirValidValues) {
  Image<float> map({3, 2});
  map.at(0, 0) = 1;
  map.at(1, 0) = 3;
  map.at(0, 1) = kInvalid;
  map.at(1, 1) = 5;
  map.at(2, 0) = kInvalid;
  map.at(2, 1) = kInvalid;
  const Image<float> shrunk = Shrunk(map.pixels(), map.size(), 2);
  ASSERT_EQ(shrunk.size(), (ImageSize{2, 1}));
  EXPECT_FLOAT_EQ(shrunk.at(0, 0), 3);
  EXPECT_TRUE(std::isnan(shrunk.at(1, 0))) << "nothing valid in the cut block";
}

TEST(RasterTest, AMapThatFitsIsLeftAsItIs) {
  const Image<float> map = HorizontalRamp({7, 5});
  const Image<float> shrunk = Shrunk(map.pixels(), map.size(), 7);
  ASSERT_EQ(shrunk.size(), map.size());
  EXPECT_EQ(shrunk.at(6, 4), 6);
}

TEST(RasterTest, TheContourOfARampStandsWhereTheRampHasItsValue) {
  const auto lines = Contour(HorizontalRamp({6, 4}), 2.25);
  ASSERT_EQ(lines.size(), 3U);  // between each two rows of centres
  for (const Segment& line : lines) {
    EXPECT_DOUBLE_EQ(line.from.x, 2.75);  // the centre of cell 2 is at 2.5
    EXPECT_DOUBLE_EQ(line.to.x, 2.75);
  }
}

TEST(RasterTest, NoContourRunsBesideAnInvalidCell) {
  Image<float> map = HorizontalRamp({6, 4});
  map.at(2, 1) = kInvalid;
  EXPECT_EQ(Contour(map, 2.25).size(), 1U);
}

TEST(RasterTest, RangeIgnoresInvalidValues) {
  Image<float> map = HorizontalRamp({4, 1});
  map.at(3, 0) = kInvalid;
  const auto range = RangeOf(map.pixels());
  ASSERT_TRUE(range.has_value());
  EXPECT_EQ(range->minimum, 0);
  EXPECT_EQ(range->maximum, 2);
  EXPECT_FALSE(RangeOf(Image<float>({2, 2}, kInvalid).pixels()).has_value());
}

TEST(ColourMapTest, EndsAreThoseOfViridisAndInvalidIsGrey) {
  EXPECT_EQ(Viridis(0), (Rgb8{68, 1, 84}));
  EXPECT_EQ(Viridis(1), (Rgb8{253, 231, 37}));
  EXPECT_EQ(Viridis(7), Viridis(1));
  Image<float> map = HorizontalRamp({3, 1});
  map.at(1, 0) = kInvalid;
  const Image<Rgb8> coloured = Coloured(map, {0, 2});
  EXPECT_EQ(coloured.at(0, 0), Viridis(0));
  EXPECT_EQ(coloured.at(1, 0), kInvalidColour);
  EXPECT_EQ(coloured.at(2, 0), Viridis(1));
}

}  // namespace
}  // namespace eyebox::service::report
