#include "fit/renderer/hdrp_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "optics/render/srgb.h"

namespace eyebox::fit {
namespace {

SceneRow GreyRow(double material) {
  SceneRow row;
  row.material = {material, material, material};
  row.facing = 0.5;
  row.directional_intensity = 2;
  row.directional_color = {1, 1, 1};
  row.ambient_intensity = 0.4;
  row.ambient_color = {0.5, 0.5, 0.5};
  return row;
}

RowPrediction Predicted(const HdrpModel& model, const SceneRow& row, RowMaterial material,
                        const optics::ColourTable* cube = nullptr) {
  const auto renderer = HdrpRenderer::Create(model, cube);
  EXPECT_TRUE(renderer.ok()) << renderer.status();
  return renderer->Predict(row, material);
}

// Equation 2 by hand: s(1) = 1; 0.822 (2 * 0.5 / pi + 0.4 * 0.5) = 0.426052.
TEST(HdrpModelTest, PublishedLambertianIsEquationTwo) {
  SceneRow row = GreyRow(1);
  const RowPrediction prediction = Predicted(HdrpModel::Published(), row, RowMaterial::kLambertian);
  EXPECT_NEAR(prediction.unprocessed[0], 0.426051, 1e-6);
  EXPECT_NEAR(prediction.stored[0], optics::LinearToSrgb(prediction.unprocessed[0]), 1e-15);
  row.exposure_stops = 3;
  EXPECT_NEAR(Predicted(HdrpModel::Published(), row, RowMaterial::kLambertian).unprocessed[2],
              0.426051 / 8, 1e-6);
}

// The ambient colour is not decoded, the directional one is.
TEST(HdrpModelTest, OnlyTheDirectionalColourIsDecoded) {
  SceneRow row = GreyRow(1);
  row.directional_color = {0.5, 0.5, 0.5};
  const double expected = 0.822 * (optics::SrgbToLinear(0.5) / std::numbers::pi + 0.2);
  EXPECT_NEAR(Predicted(HdrpModel::Published(), row, RowMaterial::kLambertian).unprocessed[1],
              expected, 1e-14);
}

TEST(HdrpModelTest, PublishedUnlitReturnsItsMaterial) {
  for (const double m : {0.0, 0.02, 0.3, 1.0}) {
    EXPECT_NEAR(Predicted(HdrpModel::Published(), GreyRow(m), RowMaterial::kUnlit).stored[0], m,
                1e-15);
  }
}

TEST(HdrpModelTest, BuffersDarkenAtMostByTheirSteps) {
  HdrpModel model;
  model.dither_mean_levels = 0;
  for (int i = 1; i <= 100; ++i) {
    const double m = i / 100.0;
    const RowPrediction prediction = Predicted(model, GreyRow(m), RowMaterial::kUnlit);
    const double u = optics::SrgbToLinear(m);
    const double shown = optics::SrgbToLinear(prediction.stored[2]);
    EXPECT_GT(shown, u * (1 - 2.0 / 32)) << m;
    // The chord between two knots, which are evenly spaced in log(u + 0.00864).
    EXPECT_LT(shown, u + 0.012 * (u + 0.00864)) << m;
  }
}

TEST(HdrpModelTest, ExtremesStayFiniteAndWithinRange) {
  SceneRow row = GreyRow(1);
  for (const double intensity : {0.0, 1e-30, 1e30, 1e300}) {
    row.directional_intensity = intensity;
    for (const double v : Predicted(HdrpModel(), row, RowMaterial::kLambertian).stored) {
      EXPECT_GE(v, 0) << intensity;
      EXPECT_LE(v, 1) << intensity;
    }
  }
}

TEST(HdrpModelTest, CubesThatDoNotFitAreRefused) {
  const optics::ColourTable cube = optics::SeparableTable({0, 0.5, 1});
  EXPECT_TRUE(HdrpRenderer::Create(HdrpModel(), &cube).ok());
  EXPECT_FALSE(HdrpRenderer::Create(HdrpModel::Published(), &cube).ok());
  const optics::ColourTable torn{3, {{0, 0, 0}}};
  EXPECT_FALSE(HdrpRenderer::Create(HdrpModel(), &torn).ok());
}

TEST(HdrpModelTest, OnlyTheTermsThatTheRowsNeedAreNamed) {
  const auto renderer = HdrpRenderer::Create(HdrpModel(), nullptr);
  SceneRow row = GreyRow(0.5);
  EXPECT_EQ(renderer->Terms({row}, RowMaterial::kUnlit), std::vector<std::string>{"material"});
  row.facing = 0;
  EXPECT_EQ(renderer->Terms({row}, RowMaterial::kLambertian),
            (std::vector<std::string>{"material", "ambient light"}));
}

}  // namespace
}  // namespace eyebox::fit
