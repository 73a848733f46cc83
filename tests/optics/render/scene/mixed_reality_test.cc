#include "optics/render/scene/mixed_reality.h"

#include <gtest/gtest.h>

#include <cmath>

namespace eyebox::optics {
namespace {

TEST(PassThroughTest, SaturatesAtTwoToTheEvTimesTheConstant) {
  EXPECT_DOUBLE_EQ(SaturatingLuminance({.ev = 0, .calibration_constant = 1.5}), 1.5);
  EXPECT_DOUBLE_EQ(SaturatingLuminance({.ev = 10, .calibration_constant = 0.125}), 128);
  EXPECT_DOUBLE_EQ(EvSaturatingAt(128, 0.125), 10);
  for (const double luminance : {1e-4, 0.3, 100.0, 1e5}) {
    const double ev = EvSaturatingAt(luminance, 0.7);
    EXPECT_NEAR(SaturatingLuminance({ev, 0.7}) / luminance, 1, 1e-14);
  }
}

// White unlit by nothing but an ambient light of the saturating luminance: u = c L / 2^e = 1.
TEST(PassThroughTest, MatchingExposureRendersTheSaturatingLuminanceAsOne) {
  for (const double ev : {-3.0, 0.0, 7.5}) {
    for (const double c : {1.0, 0.822}) {
      const PassThroughCamera camera{ev, 2.5};
      const double e = MatchingExposure(camera, c);
      EXPECT_NEAR(c * SaturatingLuminance(camera) / std::exp2(e), 1, 1e-14);
    }
  }
}

TEST(CubemapTest, GainAndExposureValuesGoBothWays) {
  EXPECT_DOUBLE_EQ(EvFromGain(8), 3);
  EXPECT_DOUBLE_EQ(GainFromEv(3), 8);
  EXPECT_DOUBLE_EQ(Ev100FromGain(100), 0);
  EXPECT_DOUBLE_EQ(Ev100FromGain(25), 2);
  EXPECT_DOUBLE_EQ(GainFromEv100(2), 25);
  for (const double gain : {1e-6, 0.37, 1.0, 5e4}) {
    EXPECT_NEAR(GainFromEv(EvFromGain(gain)) / gain, 1, 1e-14);
    EXPECT_NEAR(GainFromEv100(Ev100FromGain(gain)) / gain, 1, 1e-14);
    EXPECT_NEAR(EvFromGain(gain) + Ev100FromGain(gain), std::log2(100), 1e-13);
  }
}

TEST(CubemapTest, OneIsAHundredCandelaPerSquareMetre) {
  EXPECT_EQ(CubemapLuminance(1), 100);
  EXPECT_EQ(CubemapLuminance(2.5), 250);
  EXPECT_EQ(CubemapValue(50), 0.5);
}

TEST(WhiteBalanceTest, IdentityOnlyCuts) {
  EXPECT_EQ(BalanceWhite({10, 255, 300}, {}, 8), (Rgb{10, 255, 255}));
  EXPECT_EQ(BalanceWhite({-3, 1023, 1024}, {}, 10), (Rgb{0, 1023, 1023}));
  EXPECT_EQ(BalanceWhite({0, 1, 70000}, {}, 16), (Rgb{0, 1, 65535}));
}

TEST(WhiteBalanceTest, NanIsBlack) { EXPECT_EQ(BalanceWhite({std::nan(""), 1, 2}, {}, 8), Rgb{}); }

// By hand, with a matrix that is not symmetric: rows times matrix.
TEST(WhiteBalanceTest, ColoursAreRows) {
  WhiteBalance balance;
  balance.inverse_ccm = {{{0, 1, 0}, {0, 0, 1}, {1, 0, 0}}};  // (r, g, b) -> (b, r, g)
  balance.gains = {2, 1, 0.5};
  balance.ccm = {{{1, 1, 0}, {0, 1, 0}, {0, 0, 1}}};
  // (10, 20, 30) -> (30, 10, 20) -> (60, 10, 10) -> (60, 70, 10)
  EXPECT_EQ(BalanceWhite({10, 20, 30}, balance, 8), (Rgb{60, 70, 10}));
}

// The inner cut comes before the second matrix and is seen in the result.
TEST(WhiteBalanceTest, CutsBetweenTheMatrices) {
  WhiteBalance balance;
  balance.gains = {4, 1, 1};
  balance.ccm = {{{0.5, 0.25, 0}, {0, 1, 0}, {0, 0, 1}}};
  EXPECT_EQ(BalanceWhite({200, 0, 0}, balance, 8), (Rgb{127.5, 63.75, 0}));
  balance.inverse_ccm = {{{1, -1, 0}, {0, 1, 0}, {0, 0, 1}}};
  EXPECT_EQ(BalanceWhite({20, 0, 0}, balance, 8), (Rgb{40, 20, 0}));
}

}  // namespace
}  // namespace eyebox::optics
