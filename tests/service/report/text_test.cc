#include "service/report/text.h"

#include <gtest/gtest.h>

#include "service/report/report.h"

namespace eyebox::service::report {
namespace {

TEST(ReportTextTest, SigmaDecidesTheDecimals) {
  EXPECT_EQ(WithSigma(2.30104, 0.00412), "2.3010 ± 0.0041");
  EXPECT_EQ(WithSigma(58.8123, 1.1), "58.8 ± 1.1");
  EXPECT_EQ(WithSigma(-0.5, 0.25), "−0.50 ± 0.25");
  EXPECT_EQ(WithSigma(1234.5, 210), "1230 ± 210");
}

TEST(ReportTextTest, ASigmaThatRoundsUpADigitLosesADecimal) {
  EXPECT_EQ(WithSigma(1.0, 0.0996), "1.00 ± 0.10");
}

TEST(ReportTextTest, VerySmallAndLargeNumbersShareAPowerOfTen) {
  EXPECT_EQ(WithSigma(3.1e-7, 2e-8), "(3.10 ± 0.20) × 10⁻⁷");
  EXPECT_EQ(WithSigma(0, 0), "0");
}

TEST(ReportTextTest, MarkupAndControlCharactersCannotLeaveTheirPlace) {
  EXPECT_EQ(Escape("<script>\"a\" & 'b'</script>"),
            "&lt;script&gt;&quot;a&quot; &amp; &#39;b&#39;&lt;/script&gt;");
  EXPECT_EQ(Escape("a\x01z"), "a\uFFFDz");
}

TEST(ReportTextTest, UnitsReadAsAPersonWritesThem) {
  EXPECT_EQ(WithUnit("g", "1"), "g");
  EXPECT_EQ(WithUnit("luminance", "cd/m2"), "luminance (cd/m²)");
  EXPECT_EQ(Decimal(-0.001, 2), "0.00") << "no minus before a zero";
  EXPECT_EQ(Percent(0.00612), "0.612 %");
}

}  // namespace
}  // namespace eyebox::service::report
