#include "service/report/report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace eyebox::service::report {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr ImageSize kSize{8, 6};

// Owns what the figures borrow.
struct Example {
  std::vector<float> g = std::vector<float>(kSize.PixelCount());
  ReportInput input;

  Example() {
    for (size_t i = 0; i < g.size(); ++i) g[i] = 1 - 0.01F * static_cast<float>(i % 8);
    input.title = "A <headset> & its field";
    input.key_results = {{"gamma", WithSigma(2.301, 0.004), "0.17 %"}};
    input.facts = {{"recording", "rec"}};
    input.warnings = {"no known luminance was recorded"};
    MapFigure map;
    map.title = "Uniformity g(x)";
    map.quantity = "g";
    map.unit = "1";
    map.size = kSize;
    map.values = g;
    map.contours = {0.96};
    input.maps = {map};
    FitFigure fit;
    fit.title = "Luminance against drive value";
    fit.luminance_unit = "cd/m2";
    fit.levels = {{0, 0.2, 0.01, 0.02}, {0.5, 12, 0.1, -0.01}, {1, 59, 0.4, 0.001}};
    fit.curve = {{0, 0.2}, {0.5, 12.1}, {1, 58.9}};
    input.fit = fit;
    input.certificates = {{"linearize.cube", "hdrp, 32 knots", 0.0065, 0.0031, 0.07, {0.05, 1}}};
    input.error_curves = {{"hdrp, 32", {{0.01, 0.2}, {0.1, 0.005}, {1, -0.004}}}};
    input.parameters = {{"Activation", {{"gamma", 2.301, 0.004, "1"}, {"v0", 0, 0, "1", true}}}};
    input.history = {"subtract_dark(exposure_s=0.1)"};
  }
};

TEST(ReportTest, EverySectionIsOnThePage) {
  const Example example;
  const auto page = RenderReport(example.input);
  ASSERT_TRUE(page.ok()) << page.status();
  for (const char* text : {"What was measured", "Over the field", "Activation", "linearize.cube",
                           "0.65 %", "2.3010 ± 0.0040", "subtract_dark", "(held)",
                           "no known luminance was recorded", "data:image/png;base64,"}) {
    EXPECT_THAT(*page, HasSubstr(text));
  }
}

TEST(ReportTest, ThePageNeedsNothingFromOutside) {
  const Example example;
  const auto page = RenderReport(example.input);
  ASSERT_TRUE(page.ok()) << page.status();
  for (const char* text : {"http", "<script", "<link", "@import", "url(data", " src="}) {
    EXPECT_THAT(*page, Not(HasSubstr(text)));
  }
}

TEST(ReportTest, TextIsEscaped) {
  const Example example;
  const auto page = RenderReport(example.input);
  ASSERT_TRUE(page.ok()) << page.status();
  EXPECT_THAT(*page, HasSubstr("A &lt;headset&gt; &amp; its field"));
  EXPECT_THAT(*page, Not(HasSubstr("<headset>")));
}

TEST(ReportTest, TheSameInputGivesTheSameBytes) {
  EXPECT_EQ(*RenderReport(Example().input), *RenderReport(Example().input));
}

TEST(ReportTest, AMapWithoutAValidValueIsRefusedByName) {
  Example example;
  for (float& value : example.g) value = std::numeric_limits<float>::quiet_NaN();
  const auto page = RenderReport(example.input);
  EXPECT_EQ(page.status().code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(page.status().message(), HasSubstr("Uniformity g(x)"));
}

TEST(ReportTest, AnglesThatTurnBackAreRefused) {
  Example example;
  MapFigure& map = example.input.maps[0];
  map.column_deg = {-3, -2, -1, 0, 1, 0.5, 3, 4};
  map.row_deg = {3, 2, 1, 0, -1, -2};
  EXPECT_EQ(RenderReport(example.input).status().code(), absl::StatusCode::kInvalidArgument);
  map.column_deg[5] = 2;
  EXPECT_TRUE(RenderReport(example.input).ok());
}

TEST(ReportTest, NumbersThatAreNotFiniteAreRefused) {
  for (const double bad : {std::nan(""), HUGE_VAL}) {
    Example level;
    level.input.fit->levels[1].luminance = bad;
    EXPECT_FALSE(RenderReport(level.input).ok());
    Example certificate;
    certificate.input.certificates[0].max_relative = bad;
    EXPECT_FALSE(RenderReport(certificate.input).ok());
    Example parameter;
    parameter.input.parameters[0].rows[0].value = bad;
    EXPECT_FALSE(RenderReport(parameter.input).ok());
  }
}

TEST(ReportTest, AReportOfLittleIsStillAPage) {
  ReportInput input;
  input.title = "Empty";
  const auto page = RenderReport(input);
  ASSERT_TRUE(page.ok()) << page.status();
  EXPECT_THAT(*page, HasSubstr("</html>"));
}

}  // namespace
}  // namespace eyebox::service::report
