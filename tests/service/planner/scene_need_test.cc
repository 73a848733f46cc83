#include "service/planner/scene_need.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

namespace eyebox::service {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

v1::ScenePrediction Showing(const std::vector<std::array<double, 3>>& colours) {
  v1::ScenePrediction prediction;
  for (const auto& colour : colours) {
    v1::PatchPrediction& patch = *prediction.add_patches();
    patch.set_name("patch " + std::to_string(prediction.patches_size()));
    for (const double u : colour) patch.add_u(u);
  }
  return prediction;
}

SceneInput With(const std::vector<PatchField>& fields) {
  SceneInput scene;
  scene.patch_fields = fields;
  return scene;
}

TEST(NeedOf, GreyPatchesAskForTheirLevelsAndTheirPartOfTheField) {
  const SceneNeed need =
      NeedOf(With({{5.0, {}}, {12.0, 6.0}}), Showing({{0.4, 0.4, 0.4}, {0.9, 0.9, 0.9}}), 24);
  EXPECT_TRUE(need.need.colours.empty());
  EXPECT_THAT(need.need.grey_u, ElementsAre(0.4, 0.9));
  EXPECT_EQ(need.need.radius_deg, 12);
  EXPECT_EQ(need.need.disk_deg, 6);
  EXPECT_FALSE(need.anywhere);
  EXPECT_TRUE(need.warnings.empty());
}

TEST(NeedOf, WhatIsLitVaries) {
  SceneInput scene = With({{}, {}});
  scene.scene.materials = {optics::Unlit{}, optics::LitMaterial{}};
  scene.patches.resize(2);
  const v1::ScenePrediction shown = Showing({{0.4, 0.4, 0.4}, {0.5, 0.5, 0.5}});
  EXPECT_TRUE(NeedOf(scene, shown, 24).need.fixed);
  scene.patches[1].material = 1;
  EXPECT_FALSE(NeedOf(scene, shown, 24).need.fixed);
}

TEST(NeedOf, WhatIsOfSeveralSizesIsNotReadAtOne) {
  SceneInput scene = With({{5.0, 6.0}, {5.0, 6.0}});
  const v1::ScenePrediction shown = Showing({{0.4, 0.4, 0.4}, {0.5, 0.5, 0.5}});
  EXPECT_TRUE(NeedOf(scene, shown, 24).need.fixed);
  scene.patch_fields[1].diameter_deg = 8;
  EXPECT_FALSE(NeedOf(scene, shown, 24).need.fixed);
  scene.patch_fields[1].diameter_deg.reset();
  EXPECT_FALSE(NeedOf(scene, shown, 24).need.fixed);
}

TEST(NeedOf, OneColourAsksForThePrimaries) {
  const SceneNeed need = NeedOf(With({{}, {}}), Showing({{0.4, 0.4, 0.4}, {0.5, 0.4, 0.4}}), 24);
  EXPECT_EQ(need.need.colours.size(), 2U);
  EXPECT_EQ(need.need.radius_deg, 24);
  EXPECT_TRUE(need.anywhere);
}

TEST(NeedOf, WhatTheDisplayCannotShowIsToldOf) {
  const SceneNeed need = NeedOf(With({{60.0, {}}, {}}), Showing({{1.5, 1.5, 1.5}, {0, 0, 0}}), 24);
  EXPECT_THAT(need.need.grey_u, ElementsAre(1, kDarkestU));
  EXPECT_EQ(need.need.radius_deg, 24);
  ASSERT_EQ(need.warnings.size(), 3U);
  EXPECT_THAT(need.warnings[0], HasSubstr("patch 1 asks for 1.5 times white"));
  EXPECT_THAT(need.warnings[1], HasSubstr("patch 2 is darker"));
  EXPECT_THAT(need.warnings[2], HasSubstr("60 deg"));
}

}  // namespace
}  // namespace eyebox::service
