#include "optics/render/scene/light.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace eyebox::optics {
namespace {

using std::numbers::pi;

void ExpectDirection(const Vec3& found, const Vec3& expected) {
  EXPECT_NEAR(found.x, expected.x, 1e-15);
  EXPECT_NEAR(found.y, expected.y, 1e-15);
  EXPECT_NEAR(found.z, expected.z, 1e-15);
}

// HDRP model, eq 25, by hand: cos 30 = sqrt(3)/2, sin 30 = 1/2.
TEST(TowardsLightTest, FollowsUnitysRotations) {
  const double root3 = std::sqrt(3.0);
  ExpectDirection(TowardsLight(0, 0), {0, 0, -1});   // travels from -z to +z
  ExpectDirection(TowardsLight(90, 0), {0, 1, 0});   // from above
  ExpectDirection(TowardsLight(0, 90), {-1, 0, 0});  // from the left
  ExpectDirection(TowardsLight(30, 60), {-0.75, 0.5, -root3 / 4});
  ExpectDirection(TowardsLight(-30, 180), {0, -0.5, root3 / 2});
  ExpectDirection(TowardsLight(390, 420), TowardsLight(30, 60));
}

TEST(TowardsLightTest, RightAnglesAreExact) {
  EXPECT_EQ(TowardsLight(90, 30).z, 0);
  EXPECT_EQ(TowardsLight(0, 90).z, 0);
  EXPECT_EQ(TowardsLight(0, 180).x, 0);
  EXPECT_EQ(TowardsLight(180, 0).y, 0);
}

// The rotation applied to the direction of travel (0, 0, 1): about x first, then about y.
TEST(TowardsLightTest, IsTheRotatedTravelTurnedRound) {
  for (const double x : {-80.0, -20.0, 35.0, 160.0}) {
    for (const double y : {-130.0, 0.0, 75.0, 250.0}) {
      const double a = x * pi / 180;
      const double b = y * pi / 180;
      // About x, left-handed: z turns towards -y. About y: z turns towards x.
      const Vec3 tilted = {0, -std::sin(a), std::cos(a)};
      const Vec3 travel = {tilted.z * std::sin(b), tilted.y, tilted.z * std::cos(b)};
      ExpectDirection(TowardsLight(x, y), -1 * travel);
    }
  }
}

TEST(LightUnits, FluxBecomesIntensity) {
  EXPECT_DOUBLE_EQ(PointCandela(4 * pi), 1);
  EXPECT_DOUBLE_EQ(SpotCandelaWithoutReflector(pi), 1);
  // A cone of 120 degrees holds 2 pi (1 - cos 60) = pi sr; of nearly 360 the whole sphere.
  EXPECT_NEAR(SpotCandela(pi, 120), 1, 1e-15);
  EXPECT_NEAR(SpotCandela(1, 359.999), PointCandela(1), 1e-10);
  EXPECT_NEAR(SpotCandela(1, 1e-6) * 2 * pi * 0.5 * std::pow(0.5e-6 * pi / 180, 2), 1, 1e-9);
  EXPECT_DOUBLE_EQ(CandelaFromLux(2, 3), 18);
}

TEST(PointLightTest, FallsWithTheSquareOfTheDistance) {
  const PointLight light{{1, 0.5, 0}, 100, {0, 2, 0}, 0};
  const Arrival near = ArrivalAt(light, {});
  EXPECT_DOUBLE_EQ(near.illuminance_lux[0], 25);
  EXPECT_DOUBLE_EQ(near.illuminance_lux[1], 12.5);
  ExpectDirection(near.towards, {0, 1, 0});
  EXPECT_DOUBLE_EQ(ArrivalAt(light, {0, -2, 0}).illuminance_lux[0], 6.25);
}

TEST(PointLightTest, IsFiniteInItsOwnPlace) {
  const PointLight light{{1, 1, 1}, 1, {1, 2, 3}, 0};
  EXPECT_EQ(ArrivalAt(light, {1, 2, 3}).illuminance_lux[0], 0);
  EXPECT_DOUBLE_EQ(ArrivalAt(light, {1, 2, 3 + 1e-9}).illuminance_lux[0], 1e4);
}

TEST(PointLightTest, EndsAtItsRange) {
  const PointLight light{{1, 1, 1}, 1, {}, 2};
  EXPECT_DOUBLE_EQ(ArrivalAt(light, {1, 0, 0}).illuminance_lux[0], std::pow(15.0 / 16, 2));
  EXPECT_EQ(ArrivalAt(light, {2, 0, 0}).illuminance_lux[0], 0);
  EXPECT_EQ(ArrivalAt(light, {3, 0, 0}).illuminance_lux[0], 0);
}

TEST(SpotLightTest, IsWholeWithinAndNothingWithout) {
  const SpotLight spot{{{1, 1, 1}, 1, {}, 0}, {0, 0, 1}, 120, 0.5};
  const auto at = [&](double degrees) {
    const double angle = degrees * pi / 180;
    return ArrivalAt(spot, {std::sin(angle), 0, std::cos(angle)}).illuminance_lux[0];
  };
  EXPECT_NEAR(at(0), 1, 1e-15);
  EXPECT_NEAR(at(29.9), 1, 1e-12);
  const double middle = (std::cos(pi / 4) - 0.5) / (std::cos(pi / 6) - 0.5);
  EXPECT_NEAR(at(45), middle * middle, 1e-12);
  EXPECT_EQ(at(60.1), 0);
  EXPECT_EQ(at(180), 0);
}

TEST(SpotLightTest, HardEdgeHasNoGap) {
  const SpotLight spot{{{1, 1, 1}, 1, {}, 0}, {0, 0, 1}, 60, 1};
  EXPECT_DOUBLE_EQ(ArrivalAt(spot, {0, 0, 1}).illuminance_lux[0], 1);
  EXPECT_EQ(ArrivalAt(spot, {0, 1, 1}).illuminance_lux[0], 0);
}

}  // namespace
}  // namespace eyebox::optics
