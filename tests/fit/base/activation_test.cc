// The activation against 50-digit arithmetic over the extreme grid of drive, cutoff and gamma.
#include "fit/base/activation.h"

#include <gtest/gtest.h>

#include <array>
#include <boost/multiprecision/cpp_dec_float.hpp>
#include <cmath>
#include <limits>
#include <vector>

namespace eyebox::fit {
namespace {

using Digits50 = boost::multiprecision::cpp_dec_float_50;

constexpr double kGammas[] = {0.3, 0.5, 1, 1.8, 2.2, 3.071, 8};
constexpr double kCutoffs[] = {0, 1e-9, 0.0335, 0.5, 0.99};

struct Parameters50 {
  Digits50 minimum, range, cutoff, gamma;
};

Parameters50 Exact(const Activation& a) {
  return {Digits50(a.minimum_luminance), Digits50(a.luminance_range), Digits50(a.cutoff_drive),
          Digits50(a.gamma)};
}

Digits50 Luminance50(const Parameters50& p, const Digits50& drive) {
  const Digits50 base = (drive - p.cutoff) / (1 - p.cutoff);
  return base <= 0 ? p.minimum : Digits50(p.minimum + p.range * pow(base, p.gamma));
}

double RelativeError(double value, const Digits50& exact) {
  if (exact == 0) return std::abs(value);
  return std::abs(static_cast<double>((Digits50(value) - exact) / exact));
}

// From the cutoff's next neighbour to white's, denser at both ends.
std::vector<double> DrivesAbove(double cutoff) {
  std::vector<double> drives = {std::nextafter(cutoff, 1.0), 0.999999999, std::nextafter(1.0, 0.0),
                                1};
  for (const double share : {1e-9, 1e-5, 0.01, 0.3, 0.5, 0.7, 0.97}) {
    drives.push_back(cutoff + share * (1 - cutoff));
  }
  return drives;
}

template <typename Check>
void OverTheGrid(const Check& check) {
  for (const double gamma : kGammas) {
    for (const double cutoff : kCutoffs) {
      for (const double drive : DrivesAbove(cutoff)) {
        SCOPED_TRACE(::testing::Message()
                     << "gamma " << gamma << ", v0 " << cutoff << ", v " << drive);
        check(Activation{42.1, 421, cutoff, gamma}, drive);
      }
    }
  }
}

TEST(ActivationTest, HAgreesWithFiftyDigits) {
  OverTheGrid([](const Activation& a, double drive) {
    Parameters50 p = Exact(a);
    p.minimum = 0;
    p.range = 1;
    const Digits50 exact = Luminance50(p, Digits50(drive));
    if (exact < std::numeric_limits<double>::min()) return;  // the smallest doubles lose digits
    EXPECT_LT(RelativeError(a.H(drive), exact), 1e-14);
  });
}

TEST(ActivationTest, InverseAgreesWithFiftyDigits) {
  for (const double gamma : kGammas) {
    for (const double cutoff : kCutoffs) {
      const Activation a{0, 1, cutoff, gamma};
      for (const double h : {1e-300, 1e-12, 1e-9, 1e-3, 0.01, 0.1, 0.5, 0.9, 1 - 1e-9, 1.0}) {
        const Digits50 exact =
            Digits50(cutoff) + (1 - Digits50(cutoff)) * pow(Digits50(h), 1 / Digits50(gamma));
        if (exact < std::numeric_limits<double>::min()) continue;
        EXPECT_LT(RelativeError(a.InverseH(h), exact), 1e-12)
            << "gamma " << gamma << ", v0 " << cutoff << ", h " << h;
      }
    }
  }
}

TEST(ActivationTest, InverseUndoesH) {
  OverTheGrid([](const Activation& a, double drive) {
    const double h = a.H(drive);
    if (h < std::numeric_limits<double>::min()) return;
    // Where h is flat the rounding of h alone moves the inverse, by eps / (gamma base) at most.
    EXPECT_NEAR(a.InverseH(h), drive, 1e-14 * (1 + 1 / a.gamma));
  });
}

// The reference differentiates L itself, so that no formula is shared with the code.
TEST(ActivationTest, GradientAgreesWithDifferencesInFiftyDigits) {
  OverTheGrid([](const Activation& a, double drive) {
    Parameters50 p = Exact(a);
    p.minimum = 0;  // drops out, and would drown the dark end
    const auto slope = [&](Digits50 Parameters50::*member, const Digits50& step) {
      Parameters50 above = p;
      Parameters50 below = p;
      above.*member += step;
      below.*member -= step;
      const Digits50 v(drive);
      return Digits50((Luminance50(above, v) - Luminance50(below, v)) / (2 * step));
    };
    const Digits50 tiny("1e-15");
    const std::array<double, 4> gradient = a.LuminanceGradient(drive);
    const Digits50 above_cutoff = (Digits50(drive) - p.cutoff) * tiny;
    const Digits50 exact[] = {1, slope(&Parameters50::range, tiny),
                              slope(&Parameters50::cutoff, above_cutoff),
                              slope(&Parameters50::gamma, tiny)};
    for (int i = 0; i < 4; ++i) {
      ASSERT_TRUE(std::isfinite(gradient[i])) << i;
      if (abs(exact[i]) < 1e-290) continue;
      EXPECT_LT(RelativeError(gradient[i], exact[i]), 1e-12) << "parameter " << i;
    }
  });
}

TEST(ActivationTest, EndsAndCutoffAreExact) {
  for (const double gamma : kGammas) {
    for (const double cutoff : kCutoffs) {
      const Activation a{0.775, 420.75, cutoff, gamma};
      const std::array<double, 4> dark = {1, 0, 0, 0};
      EXPECT_EQ(a.H(0), 0);
      EXPECT_EQ(a.H(cutoff), 0);
      EXPECT_EQ(a.H(1), 1);
      EXPECT_EQ(a.InverseH(0), cutoff);
      EXPECT_EQ(a.InverseH(1), 1);
      EXPECT_EQ(a.LuminanceGradient(0), dark);
      EXPECT_EQ(a.LuminanceGradient(cutoff), dark);
      const auto white = a.LuminanceGradient(1);
      EXPECT_EQ(white[1], 1);
      EXPECT_EQ(white[2], 0);
      EXPECT_EQ(white[3], 0);
    }
  }
}

TEST(ActivationTest, DriveOutsideIsClampedAndNaNStaysVisible) {
  const Activation a{1, 100, 0.1, 2.2};
  EXPECT_EQ(a.Luminance(-3), 1);
  EXPECT_EQ(a.Luminance(7), 101);
  EXPECT_EQ(a.LuminanceGradient(7), a.LuminanceGradient(1));
  EXPECT_EQ(a.InverseH(-0.5), 0.1);
  EXPECT_EQ(a.InverseH(1.5), 1);
  EXPECT_TRUE(std::isnan(a.H(std::numeric_limits<double>::quiet_NaN())));
}

TEST(ActivationTest, WhatADarkSceneAsksOfABrightBlackIsTheCutoff) {
  // Linear luminance wants h = (1 + w) u - w, which is negative below the black of w = L0 / L1.
  const double w = 0.1;
  const Activation a{w, 1, 0.03, 2.2};
  for (const double u : {0.0, 1e-9, 0.01, 0.09}) EXPECT_EQ(a.InverseH((1 + w) * u - w), 0.03);
  EXPECT_GT(a.InverseH((1 + w) * 0.1 - w), 0.03);
}

}  // namespace
}  // namespace eyebox::fit
