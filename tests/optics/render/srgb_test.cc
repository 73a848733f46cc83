#include "optics/render/srgb.h"

#include <gtest/gtest.h>

#include <boost/multiprecision/cpp_dec_float.hpp>
#include <cmath>
#include <limits>

namespace eyebox::optics {
namespace {

using Digits50 = boost::multiprecision::cpp_dec_float_50;

constexpr double kUlp = std::numeric_limits<double>::epsilon();

Digits50 ExactToLinear(double encoded) {
  const Digits50 x = encoded;
  if (encoded <= 0.04045) return x / Digits50("12.92");
  return pow((x + Digits50("0.055")) / Digits50("1.055"), Digits50("2.4"));
}

Digits50 ExactToSrgb(double linear) {
  const Digits50 x = linear;
  if (linear <= 0.0031308) return x * Digits50("12.92");
  return Digits50("1.055") * pow(x, 1 / Digits50("2.4")) - Digits50("0.055");
}

double RelativeDifference(double value, const Digits50& exact) {
  if (exact == 0) return std::abs(value);
  return static_cast<double>(abs(Digits50(value) - exact) / abs(exact));
}

TEST(SrgbTest, BothDirectionsAgreeWithFiftyDigits) {
  double worst = 0;
  for (double x : {0.0, 1e-300, 1e-9, 0.0031307, 0.0031308, 0.0031309, 0.04044, 0.04045, 0.04046,
                   0.2, 0.5, 0.999, 1.0, 1.1, 58.9, 65504.0}) {
    worst = std::max(worst, RelativeDifference(SrgbToLinear(x), ExactToLinear(x)));
    worst = std::max(worst, RelativeDifference(LinearToSrgb(x), ExactToSrgb(x)));
  }
  for (int i = 0; i <= 4000; ++i) {
    const double x = 58.9 * std::pow(i / 4000.0, 4);
    worst = std::max(worst, RelativeDifference(SrgbToLinear(x), ExactToLinear(x)));
    worst = std::max(worst, RelativeDifference(LinearToSrgb(x), ExactToSrgb(x)));
  }
  EXPECT_LT(worst, 8 * kUlp);
}

TEST(SrgbTest, EndsAreExact) {
  EXPECT_EQ(SrgbToLinear(0), 0);
  EXPECT_EQ(SrgbToLinear(1), 1);
  EXPECT_EQ(LinearToSrgb(0), 0);
  EXPECT_NEAR(LinearToSrgb(1), 1, kUlp);
}

TEST(SrgbTest, BranchBelongsToTheLowerPieceAtTheBreak) {
  EXPECT_EQ(SrgbToLinear(0.04045), 0.04045 / 12.92);
  EXPECT_EQ(LinearToSrgb(0.0031308), 0.0031308 * 12.92);
}

// The published constants are rounded: the two pieces do not quite meet.
TEST(SrgbTest, GapAtTheBreakIsFarBelowOneOfSixteenBits) {
  EXPECT_NEAR(SrgbToLinear(std::nextafter(0.04045, 1)), SrgbToLinear(0.04045), 1e-8);
  EXPECT_NEAR(LinearToSrgb(std::nextafter(0.0031308, 1)), LinearToSrgb(0.0031308), 1e-7);
}

TEST(SrgbTest, OneUndoesTheOther) {
  for (double x : {1e-9, 0.001, 0.02, 0.1, 0.5, 1.0, 7.0, 58.9}) {
    EXPECT_NEAR(SrgbToLinear(LinearToSrgb(x)), x, 16 * kUlp * x);
  }
}

TEST(SrgbTest, NegativeValuesMirror) {
  for (double x : {0.001, 0.3, 2.0}) {
    EXPECT_EQ(SrgbToLinear(-x), -SrgbToLinear(x));
    EXPECT_EQ(LinearToSrgb(-x), -LinearToSrgb(x));
  }
}

TEST(SrgbTest, NanAndInfinityPass) {
  EXPECT_TRUE(std::isnan(SrgbToLinear(std::nan(""))));
  EXPECT_TRUE(std::isnan(LinearToSrgb(std::nan(""))));
  EXPECT_TRUE(std::isinf(SrgbToLinear(std::numeric_limits<double>::infinity())));
  EXPECT_TRUE(std::isinf(LinearToSrgb(std::numeric_limits<double>::infinity())));
}

}  // namespace
}  // namespace eyebox::optics
