// From rows of a CSV file to what the renderers store and what a display makes of it.
#include "service/predict_rows.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "capture/base/csv.h"
#include "capture/base/file.h"
#include "fit/cube/table_file.h"
#include "optics/render/srgb.h"
#include "tests/support/temporary_folder.h"

namespace eyebox::service {
namespace {

using testing::HasSubstr;

constexpr char kRows[] =
    "e,m_r,m_g,m_b,n_x,n_y,n_z,l_x,l_y,l_z,i_d,d_r,d_g,d_b,i_a,a_r,a_g,a_b\n"
    "0,0.6,0.6,0.6,0,0,-1,0.6,0,-0.8,1,1,1,1,0.25,1,1,1\n"
    "0,0.9,0.2,0.4,0,0,-1,0.6,0,-0.8,1,1,0.5,1,0,1,1,1\n";

// L0 = 0.5 +- 0.1, L1 = 100 +- 1, gamma 2 +- 0, uncorrelated.
constexpr char kActivation[] = R"({"parameters": [
  {"name": "minimum_luminance", "value": 0.5, "sigma": 0.1},
  {"name": "luminance_range", "value": 100, "sigma": 1},
  {"name": "cutoff_drive", "value": 0, "sigma": 0}, {"name": "gamma", "value": 2, "sigma": 0}],
  "model": "power_offset", "luminance_unit": "cd/m2",
  "covariance": [0.01, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]})";

class PredictRowsTest : public testing::Test {
 protected:
  PredictRowsTest() {
    request_.csv = folder_ / "rows.csv";
    request_.out = folder_ / "out.csv";
    EXPECT_TRUE(WriteFileAtomically(request_.csv, kRows).ok());
  }

  double Field(size_t row, const std::string& column) {
    const auto table = ReadCsv(request_.out, size_t{1} << 20);
    EXPECT_TRUE(table.ok()) << table.status();
    const auto found = table->FindColumn(column);
    EXPECT_TRUE(found) << column;
    return std::stod(std::string(table->Field(row, *found)));
  }

  const TemporaryFolder folder_;
  RowPredictionRequest request_;
};

TEST_F(PredictRowsTest, EveryPipelineShadesByItsOwnRule) {
  const double linear = optics::SrgbToLinear(0.6);
  const auto result = PredictRows(request_);
  ASSERT_TRUE(result.ok()) << result.status();
  const double c = 1 / 1.2;
  EXPECT_NEAR(Field(0, "u_hat_r"), (c * linear + 0.0003) * (0.8 / std::numbers::pi + 0.25), 0.002);
  request_.renderer = optics::Renderer::kUrp;
  ASSERT_TRUE(PredictRows(request_).ok());
  EXPECT_NEAR(Field(0, "u_hat_r"), linear * (0.8 + optics::SrgbToLinear(1.0) * 0.25), 1e-8);
  request_.renderer = optics::Renderer::kBuiltInGamma;
  const auto gamma = PredictRows(request_);
  ASSERT_TRUE(gamma.ok()) << gamma.status();
  EXPECT_NEAR(Field(0, "u_hat_r"), 0.6 * (0.8 + 0.25), 1e-8);
  EXPECT_NEAR(Field(0, "v_hat_r"), std::round(0.63 * 255) / 255, 1e-8);
  EXPECT_EQ(gamma->pipeline(), "built_in_gamma");
  EXPECT_EQ(gamma->model(), "");
  EXPECT_EQ(gamma->parameters_size(), 0);
  EXPECT_THAT(gamma->terms(),
              testing::ElementsAre("material", "directional light", "ambient light"));
}

TEST_F(PredictRowsTest, AGreyActivationTellsGreysAndSaysWhatItCannot) {
  request_.renderer = optics::Renderer::kBuiltInGamma;
  request_.activation = folder_ / "fit.json";
  ASSERT_TRUE(WriteFileAtomically(request_.activation, kActivation).ok());
  const auto result = PredictRows(request_);
  ASSERT_TRUE(result.ok()) << result.status();
  const double v = std::round(0.63 * 255) / 255;
  EXPECT_NEAR(Field(0, "luminance_hat"), 0.5 + 100 * v * v, 1e-5);
  EXPECT_NEAR(Field(0, "luminance_hat_sigma"), std::sqrt(0.01 + v * v * v * v), 1e-3);
  EXPECT_EQ(result->rows_without_luminance(), 1);
  const auto table = ReadCsv(request_.out, size_t{1} << 20);
  ASSERT_TRUE(table.ok());
  EXPECT_EQ(table->Field(1, *table->FindColumn("luminance_hat")), "");
  EXPECT_EQ(table->Field(1, *table->FindColumn("luminance_hat_sigma")), "");
}

TEST_F(PredictRowsTest, AStripIsLookedUpWithTheEncodedColour) {
  fit::Cube3d strip;
  strip.size = 2;  // its corners swapped: v becomes 1 - v
  for (int b = 0; b < 2; ++b) {
    for (int g = 0; g < 2; ++g) {
      for (int r = 0; r < 2; ++r) strip.entries.push_back({1.0 - r, 1.0 - g, 1.0 - b});
    }
  }
  const auto png = fit::EncodeStrip(strip);
  ASSERT_TRUE(png.ok()) << png.status();
  request_.cube = folder_ / "strip.png";
  ASSERT_TRUE(WriteFileAtomically(request_.cube, *png).ok());
  request_.renderer = optics::Renderer::kBuiltInGamma;
  const auto result = PredictRows(request_);
  ASSERT_TRUE(result.ok()) << result.status();
  EXPECT_NEAR(Field(0, "v_hat_r"), std::round(0.37 * 255) / 255, 1e-8);
}

TEST_F(PredictRowsTest, WhatAPipelineHasNotIsRefused) {
  request_.renderer = optics::Renderer::kUrp;
  request_.published = true;
  EXPECT_THAT(std::string(PredictRows(request_).status().message()), HasSubstr("--model"));
  request_.published = false;
  request_.cube = folder_ / "lut.cube";
  EXPECT_THAT(std::string(PredictRows(request_).status().message()), HasSubstr("strip PNG"));
  request_.cube.clear();
  std::string text = kRows;
  text[text.rfind("\n0,") + 1] = '1';
  ASSERT_TRUE(WriteFileAtomically(request_.csv, text).ok());
  const auto refused = PredictRows(request_);
  EXPECT_EQ(refused.status().code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(std::string(refused.status().message()), HasSubstr("row 2, column e"));
  EXPECT_FALSE(std::filesystem::exists(request_.out));
}

TEST_F(PredictRowsTest, RowsPredictedTwiceAreRefused) {
  ASSERT_TRUE(PredictRows(request_).ok());
  request_.csv = request_.out;
  EXPECT_THAT(std::string(PredictRows(request_).status().message()), HasSubstr("u_hat_r"));
}

}  // namespace
}  // namespace eyebox::service
