#include "optics/render/small_float.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

namespace eyebox::optics {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
const double kNan = std::numeric_limits<double>::quiet_NaN();

struct Form {
  SmallFloat format;
  const char* name;
};
const Form kForms[] = {{kFloat16, "16"}, {kFloat11, "11"}, {kFloat10, "10"}};

// All finite values that are not negative, ascending, by the definition of the format: the sum of
// the powers of two whose bits are set. Shares nothing with the code under test.
std::vector<double> FiniteValues(int mantissa_bits) {
  std::vector<double> values;
  for (int exponent = 0; exponent < 31; ++exponent) {
    for (int mantissa = 0; mantissa < 1 << mantissa_bits; ++mantissa) {
      double value = exponent == 0 ? 0.0 : std::pow(2.0, exponent - 15);
      for (int bit = 0; bit < mantissa_bits; ++bit) {
        if ((mantissa >> bit & 1) == 0) continue;
        value += std::pow(2.0, (exponent == 0 ? 1 : exponent) - 15 + bit - mantissa_bits);
      }
      values.push_back(value);
    }
  }
  return values;
}

TEST(SmallFloatTest, EveryBitPatternIsTheSumOfItsPowersOfTwo) {
  for (const Form& form : kForms) {
    const std::vector<double> values = FiniteValues(form.format.mantissa_bits);
    for (uint32_t bits = 0; bits < values.size(); ++bits) {
      ASSERT_EQ(DecodeSmallFloat(form.format, bits), values[bits]) << form.name << " " << bits;
      for (const Rounding rounding : {Rounding::kTruncate, Rounding::kNearestEven}) {
        ASSERT_EQ(EncodeSmallFloat(form.format, rounding, values[bits]), bits) << form.name;
        ASSERT_EQ(StoredAs(form.format, rounding, values[bits]), values[bits]) << form.name;
      }
    }
  }
}

TEST(SmallFloatTest, HalfKeepsTheSign) {
  for (uint32_t bits = 1; bits < 0x7c00; ++bits) {
    const double value = DecodeSmallFloat(kFloat16, bits | 0x8000);
    ASSERT_EQ(value, -DecodeSmallFloat(kFloat16, bits));
    ASSERT_EQ(EncodeSmallFloat(kFloat16, Rounding::kNearestEven, value), bits | 0x8000);
  }
  EXPECT_TRUE(std::signbit(StoredAs(kFloat16, Rounding::kTruncate, -1e-30)));
}

// Between neighbours a < b: truncation gives a, rounding the nearer one, and the even one halfway.
TEST(SmallFloatTest, RoundsBetweenNeighboursAsDefined) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (const Form& form : kForms) {
    const std::vector<double> values = FiniteValues(form.format.mantissa_bits);
    for (size_t i = 0; i + 1 < values.size(); ++i) {
      const double low = values[i];
      const double high = values[i + 1];
      const double middle = low + (high - low) / 2;
      const double even = i % 2 == 0 ? low : high;
      for (const double x : {low + (high - low) * uniform(random), std::nextafter(low, high),
                             std::nextafter(high, low)}) {
        ASSERT_EQ(StoredAs(form.format, Rounding::kTruncate, x), x >= high ? high : low)
            << form.name;
        const double nearest = x < middle ? low : x > middle ? high : even;
        ASSERT_EQ(StoredAs(form.format, Rounding::kNearestEven, x), nearest) << form.name;
      }
      ASSERT_EQ(StoredAs(form.format, Rounding::kNearestEven, middle), even) << form.name;
      ASSERT_EQ(StoredAs(form.format, Rounding::kTruncate, middle), low) << form.name;
    }
  }
}

TEST(SmallFloatTest, OverflowFollowsTheRounding) {
  for (const Form& form : kForms) {
    const double largest = FiniteValues(form.format.mantissa_bits).back();
    const double half_step = std::ldexp(1.0, 14 - form.format.mantissa_bits);
    for (const double x : {largest + half_step, 65536.0, 1e300}) {
      EXPECT_EQ(StoredAs(form.format, Rounding::kTruncate, x), largest) << form.name;
      EXPECT_EQ(StoredAs(form.format, Rounding::kNearestEven, x), kInfinity) << form.name;
    }
    const double below = std::nextafter(largest + half_step, 0.0);
    EXPECT_EQ(StoredAs(form.format, Rounding::kNearestEven, below), largest) << form.name;
  }
  EXPECT_EQ(FiniteValues(6).back(), 65024);
  EXPECT_EQ(FiniteValues(5).back(), 64512);
  EXPECT_EQ(FiniteValues(10).back(), 65504);
}

TEST(SmallFloatTest, NotANumberInfinityAndNegativesAreKeptOrCut) {
  for (const Rounding rounding : {Rounding::kTruncate, Rounding::kNearestEven}) {
    for (const Form& form : kForms) {
      EXPECT_TRUE(std::isnan(StoredAs(form.format, rounding, kNan))) << form.name;
      const uint32_t nan_bits = EncodeSmallFloat(form.format, rounding, kNan);
      EXPECT_TRUE(std::isnan(DecodeSmallFloat(form.format, nan_bits))) << form.name;
      EXPECT_EQ(StoredAs(form.format, rounding, kInfinity), kInfinity) << form.name;
      const uint32_t infinity_bits = EncodeSmallFloat(form.format, rounding, kInfinity);
      EXPECT_EQ(infinity_bits, 31U << form.format.mantissa_bits) << form.name;
      EXPECT_EQ(DecodeSmallFloat(form.format, infinity_bits), kInfinity) << form.name;
    }
    EXPECT_EQ(StoredAs(kFloat16, rounding, -kInfinity), -kInfinity);
    for (const double negative : {-kInfinity, -1.0, -1e-300, -0.0}) {
      for (const SmallFloat format : {kFloat11, kFloat10}) {
        EXPECT_EQ(StoredAs(format, rounding, negative), 0) << negative;
        EXPECT_FALSE(std::signbit(StoredAs(format, rounding, negative))) << negative;
      }
    }
  }
}

TEST(SmallFloatTest, TheSmallestDenormalDecidesWhatBecomesZero) {
  for (const Form& form : kForms) {
    const double smallest = FiniteValues(form.format.mantissa_bits)[1];
    EXPECT_EQ(smallest, std::ldexp(1.0, -14 - form.format.mantissa_bits)) << form.name;
    EXPECT_EQ(StoredAs(form.format, Rounding::kTruncate, smallest * 0.999), 0) << form.name;
    EXPECT_EQ(StoredAs(form.format, Rounding::kNearestEven, smallest * 0.5), 0) << form.name;
    EXPECT_EQ(StoredAs(form.format, Rounding::kNearestEven, smallest * 0.501), smallest);
  }
}

}  // namespace
}  // namespace eyebox::optics
