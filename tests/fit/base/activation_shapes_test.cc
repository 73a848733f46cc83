// The toe and the warp of an activation: monotone, C1, inverted exactly, derivatives true.
#include <gtest/gtest.h>

#include <boost/multiprecision/cpp_dec_float.hpp>
#include <cmath>
#include <vector>

#include "fit/base/activation.h"

namespace eyebox::fit {
namespace {

using Digits50 = boost::multiprecision::cpp_dec_float_50;

const std::vector<double> kPlaces = {0, 0.2, 0.55, 1};
const std::vector<double> kLogSlopes = {-1.2, 0.8, -0.3, 0};

std::vector<Activation> Shapes() {
  std::vector<Activation> shapes;
  for (const double gamma : {0.5, 1.0, 2.4, 8.0}) {
    for (const double cutoff : {0.0, 0.05}) {
      for (const double toe : {0.0, 1e-6, 0.0393, 0.7}) {
        shapes.push_back({1, 100, cutoff, gamma, toe});
        shapes.push_back(
            {1, 100, cutoff, gamma, toe, MonotoneWarp::FromLogSlopes(kPlaces, kLogSlopes)});
      }
    }
  }
  return shapes;
}

TEST(ActivationShapesTest, InverseAndItsSlopeUndoH) {
  for (const Activation& a : Shapes()) {
    SCOPED_TRACE(::testing::Message()
                 << "gamma " << a.gamma << ", v0 " << a.cutoff_drive << ", toe " << a.toe_drive);
    for (const double drive : {0.06, 0.1, 0.25, 0.5, 0.73, 0.99, 1 - 1e-9, 1.0}) {
      const double h = a.H(drive);
      // The rounding of h alone moves the inverse by eps h / slope.
      EXPECT_NEAR(a.InverseH(h) / drive, 1, 1e-12 + 4e-16 * h / a.Slope(drive) / drive);
      EXPECT_NEAR(a.InverseSlope(h) * a.Slope(drive), 1, 1e-11);
    }
  }
}

TEST(ActivationShapesTest, EndsAreExactAndDerivativesFinite) {
  for (const Activation& a : Shapes()) {
    EXPECT_EQ(a.H(0), 0);
    EXPECT_EQ(a.H(a.cutoff_drive), 0);
    EXPECT_EQ(a.H(1), 1);
    EXPECT_EQ(a.InverseH(0), a.cutoff_drive);
    EXPECT_EQ(a.InverseH(1), 1);
    for (const double drive : {-1.0, 0.0, 5e-324, a.cutoff_drive, 1.0, 2.0}) {
      EXPECT_TRUE(std::isfinite(a.Slope(drive)) && std::isfinite(a.InverseSlope(drive)));
      EXPECT_TRUE(std::isfinite(a.LuminanceByToe(drive)));
      for (const double d : a.LuminanceGradient(drive)) EXPECT_TRUE(std::isfinite(d));
      for (const double d : a.LuminanceByWarp(drive)) EXPECT_TRUE(std::isfinite(d));
    }
  }
}

TEST(ActivationShapesTest, RisesWithAContinuousSlope) {
  for (const Activation& a : Shapes()) {
    std::vector<double> joints = {a.cutoff_drive +
                                  (1 - a.cutoff_drive) * a.warp.InverseAt(a.toe_drive)};
    for (const double place : kPlaces)
      joints.push_back(a.cutoff_drive + (1 - a.cutoff_drive) * place);
    for (const double joint : joints) {
      if (joint <= a.cutoff_drive + 1e-5 || joint >= 1) continue;
      const double before = a.Slope(joint - 1e-9);
      EXPECT_NEAR(a.Slope(joint + 1e-9) / before, 1, 1e-5);
      EXPECT_GT(before, 0);
      EXPECT_GT(a.H(joint + 1e-6), a.H(joint - 1e-6));
    }
  }
}

// sRGB itself but for the published constants' own gap at the break (a toe of 0.0393 where the
// standard writes 0.04045).
TEST(ActivationShapesTest, ToeIsTheFormOfSrgb) {
  const Activation a{0, 1, 0, 2.4, 0.055 / 1.4};
  EXPECT_NEAR(a.H(0.02) / (0.02 / 12.92), 1, 2e-3);
  EXPECT_NEAR(a.H(0.5) / std::pow((0.5 + 0.055) / 1.055, 2.4), 1, 1e-14);
}

// The formulas once more, in 50 digits.
Digits50 Toe50(const Digits50& y, const Digits50& toe, const Digits50& gamma) {
  const Digits50 a = toe * (gamma - 1);
  if (y < toe) return Digits50(pow(Digits50(toe * gamma / (1 + a)), gamma) / toe * y);
  return Digits50(pow(Digits50((y + a) / (1 + a)), gamma));
}

TEST(ActivationShapesTest, DerivativesByGammaAndToeAgreeWithDifferencesInFiftyDigits) {
  const Digits50 step("1e-18");
  for (const double gamma : {0.5, 2.4, 8.0}) {
    for (const double toe : {1e-6, 0.0393, 0.7}) {
      const Activation a{0, 1, 0, gamma, toe};
      for (const double drive : {1e-9, 0.02, 0.1, 0.5, 0.9, 1 - 1e-9}) {
        const Digits50 v(drive), b(toe), g(gamma);
        const auto by_gamma =
            static_cast<double>((Toe50(v, b, g + step) - Toe50(v, b, g - step)) / (2 * step));
        const auto by_toe =
            static_cast<double>((Toe50(v, b + step, g) - Toe50(v, b - step, g)) / (2 * step));
        EXPECT_NEAR(a.H(drive) / static_cast<double>(Toe50(v, b, g)), 1, 1e-13);
        // Near white the two parts of the derivative by gamma nearly cancel where toe is wide.
        EXPECT_NEAR(a.LuminanceGradient(drive)[3] / by_gamma, 1, 1e-10) << gamma << " " << toe;
        EXPECT_NEAR(a.LuminanceByToe(drive) / by_toe, 1, 1e-12) << gamma << " " << toe;
      }
    }
  }
}

TEST(ActivationShapesTest, WarpDerivativesAreTheDifferences) {
  const double step = 1e-6;
  for (const double drive : {0.1, 0.3, 0.6, 0.95}) {
    const Activation a{1, 100, 0.05, 2.4, 0, MonotoneWarp::FromLogSlopes(kPlaces, kLogSlopes)};
    const std::vector<double> derivatives = a.LuminanceByWarp(drive);
    for (size_t j = 0; j < kPlaces.size(); ++j) {
      Activation above = a, below = a;
      std::vector<double> moved = kLogSlopes;
      moved[j] += step;
      above.warp = MonotoneWarp::FromLogSlopes(kPlaces, moved);
      moved[j] -= 2 * step;
      below.warp = MonotoneWarp::FromLogSlopes(kPlaces, moved);
      const double difference = (above.Luminance(drive) - below.Luminance(drive)) / (2 * step);
      EXPECT_NEAR(derivatives[j], difference, 1e-7 * std::abs(difference) + 1e-8);
    }
  }
}

TEST(MonotoneWarpTest, RefusesWhatIsNoWarp) {
  EXPECT_TRUE(MonotoneWarp::IsValid(kPlaces, kLogSlopes));
  EXPECT_FALSE(MonotoneWarp::IsValid({{0.0}}, {{0.0}}));
  EXPECT_FALSE(MonotoneWarp::IsValid({{0.0, 0.9}}, {{0.0, 0.0}}));
  EXPECT_FALSE(MonotoneWarp::IsValid({{0.0, 0.5, 0.5, 1.0}}, kLogSlopes));
  EXPECT_FALSE(MonotoneWarp::IsValid({{0.0, 1.0}}, {{std::nan(""), 0.0}}));
}

}  // namespace
}  // namespace eyebox::fit
