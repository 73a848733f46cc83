#include "fit/renderer/compare_models.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "optics/render/render_pipeline.h"

namespace eyebox::fit {
namespace {

// Rows that a known model rendered, dithered and rounded.
RenderedSet Simulated(const HdrpModel& truth, int rows, RowMaterial material) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(0, 1);
  const auto renderer = HdrpRenderer::Create(truth, nullptr);
  RenderedSet set{"simulated", material, {}, {}};
  for (int i = 0; i < rows; ++i) {
    SceneRow row;
    row.material = {uniform(random), uniform(random), uniform(random)};
    row.facing = uniform(random);
    row.directional_intensity = 3 * uniform(random);
    row.directional_color = {uniform(random), uniform(random), uniform(random)};
    row.ambient_intensity = uniform(random);
    row.ambient_color = {uniform(random), uniform(random), uniform(random)};
    optics::Rgb v = renderer->Predict(row, material).stored;
    const double dither = (uniform(random) - uniform(random)) / 255;
    for (double& value : v) value += dither;
    row.stored = optics::QuantiseTo8Bits{}.Apply(v);
    set.rows.push_back(row);
  }
  return set;
}

HdrpModel Truth(double scale, double floor) {
  HdrpModel model;
  model.light_scale = scale;
  model.reflectance_floor = floor;
  model.dither_mean_levels = 0;
  return model;
}

TEST(CompareModelsTest, FindsTheParametersThatRendered) {
  const std::vector<RenderedSet> sets = {
      Simulated(Truth(0.81, 0.0006), 200, RowMaterial::kLambertian)};
  const Hypothesis hypothesis{"both", Truth(0.8, 0), true, true};
  const auto compared = CompareModels(sets, {hypothesis});
  ASSERT_TRUE(compared.ok()) << compared.status();
  const std::vector<Parameter>& found = compared->front().parameters;
  EXPECT_NEAR(found[0].value, 0.81, 4 * found[0].sigma);
  EXPECT_NEAR(found[1].value, 0.0006, 4 * found[1].sigma);
  EXPECT_LT(found[0].sigma, 0.004);
  EXPECT_LT(found[1].sigma, 0.0005);
}

TEST(CompareModelsTest, RanksTheModelThatRenderedFirst) {
  const std::vector<RenderedSet> sets = {
      Simulated(Truth(1 / 1.2, 0), 200, RowMaterial::kLambertian)};
  const auto compared = CompareModels(sets, StandardHypotheses(), {.bootstrap_samples = 2});
  ASSERT_TRUE(compared.ok()) << compared.status();
  const auto mean_of = [&](const std::string& part) {
    for (const ComparedModel& model : *compared) {
      if (model.hypothesis.name.find(part) != std::string::npos) return model.mean_held_out;
    }
    ADD_FAILURE() << part;
    return 0.0;
  };
  EXPECT_LT(mean_of("lights stored apart") + 0.05, mean_of("published"));
  EXPECT_LT(mean_of("lights stored apart") + 0.05, mean_of("buffers, rounded"));
  EXPECT_LT(mean_of("lights stored apart"), mean_of("buffers, truncated"));
}

TEST(CompareModelsTest, AFaultyRowMovesNothing) {
  RenderedSet set = Simulated(Truth(0.82, 0), 100, RowMaterial::kLambertian);
  const Hypothesis hypothesis{"scale", Truth(0.8, 0), true, false};
  const auto clean = CompareModels({set}, {hypothesis});
  set.rows[0].stored = {1, 1, 1};
  const auto faulty = CompareModels({set}, {hypothesis});
  ASSERT_TRUE(clean.ok() && faulty.ok());
  EXPECT_NEAR(faulty->front().parameters[0].value, clean->front().parameters[0].value, 0.0021);
}

TEST(CompareModelsTest, ErrorsAreCountedInLevels) {
  RenderedSet set{"two", RowMaterial::kUnlit, {SceneRow(), SceneRow()}, {}};
  set.rows[0].stored = {0, 0, 0};
  set.rows[1].stored = {1, 1, 1};
  const SetError error = ErrorOf(set, {{1.0 / 255, 0, 0}, {1, 1 - 2.0 / 255, 1 - 3.0 / 255}});
  EXPECT_EQ(error.values, 6);
  EXPECT_NEAR(error.median, 0.5, 1e-9);
  EXPECT_NEAR(error.mean, 1, 1e-9);
  EXPECT_NEAR(error.bias[0], 0.5, 1e-9);
  EXPECT_NEAR(error.bias[2], -1.5, 1e-9);
  EXPECT_NEAR(error.bias_sigma[0], 0.5, 1e-9);
}

TEST(CompareModelsTest, TooFewRowsAreRefused) {
  EXPECT_FALSE(CompareModels({}, StandardHypotheses()).ok());
  const RenderedSet set = Simulated(Truth(0.8, 0), 9, RowMaterial::kUnlit);
  EXPECT_FALSE(CompareModels({set}, StandardHypotheses()).ok());
  EXPECT_FALSE(CompareModels({set}, StandardHypotheses(), {.folds = 1}).ok());
}

}  // namespace
}  // namespace eyebox::fit
