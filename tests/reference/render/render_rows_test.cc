// Rows that Unity rendered, against every model; each row predicted by a fit without it.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "fit/renderer/compare_models.h"
#include "fit/renderer/known_knots.h"

namespace eyebox::fit {
namespace {

const std::filesystem::path kFolder =
    std::filesystem::path(EYEBOX_SOURCE_DIR) / "../shared/reference/render";

struct File {
  const char* name;
  RowMaterial material;
  double (*entry)(double u);  // of the cube at a knot, null without cube
  double bar;                 // the median to stay under, 1/255
};
const File kFiles[] = {
    {"unlit", RowMaterial::kUnlit, nullptr, 0.42},
    {"lambertian", RowMaterial::kLambertian, nullptr, 0.48},
    {"lambertian_lut_linear", RowMaterial::kLambertian, [](double u) { return u; }, 0.45},
    {"lambertian_lut_square", RowMaterial::kLambertian, [](double u) { return u * u; }, 0.38},
    {"lambertian_lut_square_root", RowMaterial::kLambertian, [](double u) { return std::sqrt(u); },
     0.54}};

// Entries as the source made them: of the knots of table 2(b), those after the first above 1 cut.
optics::ColourTable CubeOf(double (*entry)(double)) {
  std::vector<double> entries = {0, 0};
  bool is_past_one = false;
  for (const double u : KnotsFromOptimisation()) {
    entries.push_back(is_past_one ? 1 : entry(u));
    is_past_one = is_past_one || entry(u) > 1;
  }
  return optics::SeparableTable(entries);
}

std::vector<RenderedSet> ReadSets() {
  std::vector<RenderedSet> sets;
  for (const File& file : kFiles) {
    auto rows = ReadSceneRows(kFolder / (std::string(file.name) + ".csv"), file.material);
    EXPECT_TRUE(rows.ok()) << rows.status();
    if (!rows.ok()) return {};
    RenderedSet set{file.name, file.material, *std::move(rows), {}};
    // Row 1 of that file is a capture of a white screen.
    if (set.name == "lambertian") set.rows.erase(set.rows.begin());
    if (file.entry != nullptr) set.cube = CubeOf(file.entry);
    sets.push_back(std::move(set));
  }
  return sets;
}

void Print(const ComparedModel& model) {
  std::printf("%-34s", model.hypothesis.name.c_str());
  for (const Parameter& parameter : model.parameters) {
    std::printf(" %.5f+-%.5f", parameter.value, parameter.sigma);
  }
  std::printf("  mean %.3f bias %+.2f %+.2f %+.2f\n", model.mean_held_out, model.bias[0],
              model.bias[1], model.bias[2]);
  for (size_t i = 0; i < model.held_out.size(); ++i) {
    const SetError& error = model.held_out[i];
    std::printf(
        "    %-27s held out: median %.3f mean %.3f bias %+.2f %+.2f %+.2f (+- %.2f)"
        "  in sample: median %.3f\n",
        error.set.c_str(), error.median, error.mean, error.bias[0], error.bias[1], error.bias[2],
        error.bias_sigma[1], model.in_sample[i].median);
  }
}

const ComparedModel* Find(const std::vector<ComparedModel>& models, const std::string& part) {
  for (const ComparedModel& model : models) {
    if (model.hypothesis.name.find(part) != std::string::npos) return &model;
  }
  return nullptr;
}

class RenderRowsTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(kFolder)) GTEST_SKIP() << kFolder << " is absent: no real rows";
  }
};

TEST_F(RenderRowsTest, HeldOutRowsArePredictedBetterThanPublished) {
  const auto compared = CompareModels(ReadSets(), StandardHypotheses());
  ASSERT_TRUE(compared.ok()) << compared.status();
  std::printf("|predicted - stored| in 1/255; light_scale, reflectance_floor, dither_mean\n");
  for (const ComparedModel& model : *compared) Print(model);
  const ComparedModel* published = Find(*compared, "published");
  for (const char* name : {"mean of the dither", "default of this program"}) {
    const ComparedModel* model = Find(*compared, name);
    ASSERT_NE(model, nullptr);
    for (size_t i = 0; i < model->held_out.size(); ++i) {
      EXPECT_LE(model->held_out[i].median, kFiles[i].bar) << name << ", " << kFiles[i].name;
    }
    // Not in every file: through the linear cube the published model's mean is 5 % smaller.
    EXPECT_LT(model->mean_held_out, 0.85 * published->mean_held_out) << name;
    for (const double bias : model->bias) EXPECT_LE(std::abs(bias), 0.1) << name;
  }
  // The light scale, left free, is HDRP's conversion of EV100 to exposure.
  const ComparedModel* free_scale = Find(*compared, "HSV + lights stored apart");
  ASSERT_NE(free_scale, nullptr);
  EXPECT_NEAR(free_scale->parameters[0].value, 1 / 1.2, 3 * free_scale->parameters[0].sigma);
}

}  // namespace
}  // namespace eyebox::fit
