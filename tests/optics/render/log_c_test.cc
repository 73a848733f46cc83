#include "optics/render/log_c.h"

#include <gtest/gtest.h>

#include <array>
#include <boost/multiprecision/cpp_dec_float.hpp>
#include <cmath>

namespace eyebox::optics {
namespace {

using Digits50 = boost::multiprecision::cpp_dec_float_50;

Digits50 Exact(double u) {
  return Digits50("0.244161") * log10(Digits50("5.555556") * Digits50(u) + Digits50("0.047996")) +
         Digits50("0.386036");
}

TEST(LogCTest, AgreesWithFiftyDigits) {
  for (double u : {0.0, 1e-9, 1e-4, 0.05, 0.18, 1.0, 10.0, 58.8}) {
    EXPECT_NEAR(LinearToLogC(u), static_cast<double>(Exact(u)), 1e-15) << u;
  }
}

TEST(LogCTest, AxisEndsWhereItIsKnownTo) {
  EXPECT_NEAR(LogCToLinear(1), 58.85666, 5e-5);
  EXPECT_NEAR(31 * LinearToLogC(0), 1.985, 5e-4);
  EXPECT_EQ(LinearToLogC(100), 1);
  EXPECT_EQ(LinearToLogC(-1), 0);
  EXPECT_EQ(LinearToLogC(LogCToLinear(0) - 1e-6), 0);
}

TEST(LogCTest, OneUndoesTheOther) {
  for (int i = 0; i <= 128; ++i) {
    EXPECT_NEAR(LinearToLogC(LogCToLinear(i / 128.0)), i / 128.0, 1e-14);
  }
}

// Murray, HDRP model, table 2(a): knots found by single-entry cubes, sixth (u = 0.0129) to last.
TEST(LogCTest, KnotsAreThoseMeasuredInTheRenderer) {
  constexpr std::array kMeasured = {0.01288, 0.02056, 0.03061, 0.04468, 0.06393, 0.09056, 0.1245,
                                    0.1711,  0.2354,  0.3236,  0.4406,  0.5938,  0.8165,  1.111,
                                    1.498,   2.039,   2.776,   3.780,   5.094,   6.935,   9.441,
                                    12.72,   17.32,   23.35,   31.78,   43.27,   58.90};
  for (size_t i = 0; i < kMeasured.size(); ++i) {
    const double knot = LogCToLinear(static_cast<double>(i + 5) / 31);
    EXPECT_NEAR(kMeasured[i] / knot, 1, 0.02) << "entry " << i + 6;
  }
}

TEST(LogCTest, NanPasses) { EXPECT_TRUE(std::isnan(LinearToLogC(std::nan("")))); }

}  // namespace
}  // namespace eyebox::optics
