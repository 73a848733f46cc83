#include "optics/scatter/radial_profile.h"

#include <gtest/gtest.h>

#include <cmath>

namespace eyebox::optics {
namespace {

MeasuredImage Cone() {
  MeasuredImage image = MakeMeasuredImage({41, 41}, "cd/m2");
  for (int y = 0; y < 41; ++y) {
    for (int x = 0; x < 41; ++x) {
      image.value.at(x, y) = static_cast<float>(std::hypot(x - 20, y - 20) * 0.1);
      image.variance.at(x, y) = 0.04F;
    }
  }
  return image;
}

TEST(RadialProfileTest, RingsHoldTheirMeanAndItsSigma) {
  const auto readings =
      MeasureRadialProfile(Cone(), 20, 20, 0.1, std::vector<double>{0, 0.05, 0.5, 1.0, 50, 60});
  ASSERT_TRUE(readings.ok()) << readings.status();
  ASSERT_EQ(readings->size(), 4);  // the last ring lies outside
  EXPECT_EQ((*readings)[0].pixels, 1);
  EXPECT_EQ((*readings)[0].value, 0);
  EXPECT_NEAR((*readings)[0].sigma, 0.2, 1e-6);
  EXPECT_NEAR((*readings)[2].value, (*readings)[2].offset_deg, 0.03);
  EXPECT_NEAR((*readings)[2].sigma, 0.2 / std::sqrt((*readings)[2].pixels), 1e-6);
}

TEST(RadialProfileTest, MaskedPixelsAreLeftOut) {
  MeasuredImage image = Cone();
  image.mask.at(20, 20) = kSaturated;
  BlankMaskedPixels(image);
  const auto readings = MeasureRadialProfile(image, 20, 20, 0.1, std::vector<double>{0, 0.05, 1});
  ASSERT_TRUE(readings.ok());
  EXPECT_EQ(readings->size(), 1);
  EXPECT_EQ(MeasureRadialProfile(image, 20, 20, 0.1, std::vector<double>{0, 0.05}).status().code(),
            absl::StatusCode::kFailedPrecondition);
}

TEST(RadialProfileTest, EdgesMustAscend) {
  for (const std::vector<double>& edges : {std::vector<double>{1}, {1, 1}, {-1, 1}, {2, 1}}) {
    EXPECT_EQ(MeasureRadialProfile(Cone(), 20, 20, 0.1, edges).status().code(),
              absl::StatusCode::kInvalidArgument);
  }
}

}  // namespace
}  // namespace eyebox::optics
