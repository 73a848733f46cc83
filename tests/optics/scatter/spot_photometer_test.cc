// The appendix on spot photometers of Murray, Patel & Wiedenmann 2022: equations 3 to 9, figure 6.
#include "optics/scatter/spot_photometer.h"

#include <gtest/gtest.h>

#include <cmath>

namespace eyebox::optics {
namespace {

constexpr double kPitchDeg = 0.25;
constexpr int kSize = 161;  // 40 degrees
constexpr int kMiddle = kSize / 2;
constexpr double kBackground = 0.19;  // cd/m2, full field at u = 0
constexpr double kPeak = 59;          // cd/m2, full field at u = 1

// Through the headset: nominal 0.33 degrees, stray light from beyond 15 degrees.
SpotPhotometer ThroughHeadset() {
  return {{.core = CoreShape::kDisk,
           .tail = TailShape::kMoffat,
           .core_radius_deg = 0.165,
           .tail_share = 0.4,
           .tail_radius_deg = 3,
           .tail_exponent = 2.5,
           .reach_deg = 50},
          0.33};
}

SpotPhotometer OnFlatPanel() {
  SpotPhotometer photometer = ThroughHeadset();
  photometer.weight.tail_share = 0.01;
  return photometer;
}

double RadiusDeg(int x, int y) { return std::hypot(x - kMiddle, y - kMiddle) * kPitchDeg; }

// g(x): brighter in the middle, as headsets are.
double Nonuniformity(int x, int y) { return 1 - 0.5 * std::pow(RadiusDeg(x, y) / 28, 2); }

// I = T f(u) + B, T within `radius_deg` only (eq 5), all of it g (eq 7) if that is large.
Image<float> Scene(double activation, double radius_deg) {
  Image<float> scene({kSize, kSize});
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) {
      const double target = RadiusDeg(x, y) <= radius_deg ? (kPeak - kBackground) * activation : 0;
      scene.at(x, y) = static_cast<float>(Nonuniformity(x, y) * (target + kBackground));
    }
  }
  return scene;
}

struct Pair {
  double real = 0;
  double ideal = 0;
};

Pair ReadBoth(const Image<float>& scene) {
  const auto real = ReadScene(ThroughHeadset(), scene, kPitchDeg, kMiddle, kMiddle);
  const auto ideal = ReadSceneIdeally(ThroughHeadset(), scene, kPitchDeg, kMiddle, kMiddle);
  EXPECT_TRUE(real.ok() && ideal.ok());
  return {*real, *ideal};
}

TEST(SpotPhotometerTest, FullFieldReadingIsProportionalToTheIdealOne) {
  const Pair white = ReadBoth(Scene(1, 1000));
  EXPECT_LT(white.real, 0.99 * white.ideal);  // a scale is lost, no more
  for (const double activation : {0.0, 0.001, 0.01, 0.1, 0.5}) {
    const Pair pair = ReadBoth(Scene(activation, 1000));
    EXPECT_NEAR(pair.real / white.real, pair.ideal / white.ideal, 1e-6 * pair.ideal / white.ideal)
        << activation;
  }
}

TEST(SpotPhotometerTest, SmallPatchAddsTheScatteredBackground) {
  const Pair white = ReadBoth(Scene(1, 0.5));
  const Pair black = ReadBoth(Scene(0, 0.5));
  const Pair dark = ReadBoth(Scene(0.005, 0.5));
  // Not proportional: at the dark end the real reading is too bright by far ...
  EXPECT_GT(black.real / white.real, 1.3 * black.ideal / white.ideal);
  EXPECT_GT(dark.real / white.real, 1.05 * dark.ideal / white.ideal);
  // ... by a constant: what u adds is proportional (eq 6).
  EXPECT_NEAR((dark.real - black.real) / (white.real - black.real),
              (dark.ideal - black.ideal) / (white.ideal - black.ideal), 1e-5);
}

TEST(SpotPhotometerTest, GrowingDiskHasTheShapeOfTheFigure) {
  const auto reading = [](const SpotPhotometer& photometer, double diameter) {
    const auto p = ReadDisk(photometer, {diameter, kPeak, kBackground, 50});
    EXPECT_TRUE(p.ok());
    return *p;
  };
  const double full = reading(ThroughHeadset(), 100);
  EXPECT_NEAR(full, kPeak, 1e-9);
  EXPECT_NEAR(reading(ThroughHeadset(), 0), kBackground, 1e-9);
  // Through the headset the reading goes on rising far beyond 15 degrees; the nominal region has
  // little more than its core. On the flat panel it has nearly all.
  EXPECT_LT(reading(ThroughHeadset(), 0.33), 0.62 * full);
  EXPECT_LT(reading(ThroughHeadset(), 15), 0.95 * full);
  EXPECT_GT(reading(OnFlatPanel(), 0.33), 0.98 * full);
  double before = 0;
  for (double diameter = 0.05; diameter < 60; diameter *= 1.3) {
    const double now = reading(ThroughHeadset(), diameter);
    EXPECT_GT(now, before) << diameter;
    before = now;
  }
}

TEST(SpotPhotometerTest, ClosedFormIsTheSumOverTheScene) {
  constexpr double kFine = 0.05;
  SpotPhotometer photometer = ThroughHeadset();
  photometer.weight.reach_deg = 6;
  Image<float> scene({301, 301});
  for (int y = 0; y < 301; ++y) {
    for (int x = 0; x < 301; ++x)
      scene.at(x, y) = std::hypot(x - 150, y - 150) * kFine < 2 ? 30 : 2;
  }
  const auto closed = ReadDisk(photometer, {4, 30, 2, 50});
  const auto summed = ReadScene(photometer, scene, kFine, 150, 150);
  ASSERT_TRUE(closed.ok() && summed.ok());
  EXPECT_NEAR(*summed, *closed, 5e-3 * *closed);
}

TEST(SpotPhotometerTest, AimOutsideIsRefused) {
  const Image<float> scene({20, 20}, 1.0F);
  EXPECT_FALSE(ReadScene(ThroughHeadset(), scene, kPitchDeg, 20, 3).ok());
  EXPECT_FALSE(ReadSceneIdeally(ThroughHeadset(), scene, kPitchDeg, 0, 3).ok());
  EXPECT_FALSE(ReadDisk(ThroughHeadset(), {-1, 1, 0, 50}).ok());
  EXPECT_FALSE(ReadDisk(ThroughHeadset(), {1, NAN, 0, 50}).ok());
}

}  // namespace
}  // namespace eyebox::optics
