// Scene files: what is read, and that whatever is wrong is named.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>
#include <string>

#include "service/scene/read_scene.h"

namespace eyebox::service {
namespace {

using testing::HasSubstr;

constexpr char kExample[] = EYEBOX_SOURCE_DIR "/fixtures/scenes/hdrp.textproto";

std::string With(const std::string& more) { return "renderer: SCENE_RENDERER_HDRP\n" + more; }

const std::string kCard = "materials { name: 'm' lambert { color { r: 1 g: 1 b: 1 } } }\n";
const std::string kPatch = "patches { name: 'p' material: 'm' }\n";

TEST(SceneFileTest, ExampleIsRead) {
  const auto input = ReadScene(kExample);
  ASSERT_TRUE(input.ok()) << input.status();
  EXPECT_EQ(input->patch_names[3], "enamel");
  EXPECT_EQ(input->scene.settings.exposure_ev, 0.5);
  const auto& lamp = std::get<optics::SpotLight>(input->scene.lights[2]);
  // 20 lm within a cone of 60 degrees.
  const double cone_sr = 2 * std::numbers::pi * (1 - std::cos(std::numbers::pi / 6));
  EXPECT_NEAR(lamp.source.intensity_cd, 20 / cone_sr, 1e-12);
  EXPECT_DOUBLE_EQ(lamp.inner_fraction, 0.5);
  EXPECT_NEAR(input->patches[2].normal.y, std::sqrt(0.5), 1e-15);
  EXPECT_EQ(input->mixed_reality->balance.gains[0], 1.1);
}

TEST(SceneFileTest, EyeIsNotNeededWhereItDoesNotMatter) {
  const auto input = ParseScene(With(kCard + kPatch), "s.textproto");
  ASSERT_TRUE(input.ok()) << input.status();
  EXPECT_EQ(input->patches[0].view.z, -1);
}

struct Wrong {
  std::string text;
  std::string where;
  std::string what;
};

TEST(SceneFileTest, WhatIsWrongIsNamed) {
  const std::string lit =
      "materials { name: 'm' hdrp_lit { base_color { r: 1 } smoothness: 0.5 } }\n";
  const std::string sun = "lights { name: 'sun' directional { intensity: 1 } }\n";
  const Wrong table[] = {
      {"renderer: SCENE_RENDERER_HDRP\nnonsense: 1\n", "s.textproto:2", "nonsense"},
      {kCard + kPatch, "s.textproto renderer", "not given"},
      {With(kCard), "s.textproto", "no patches"},
      {With(kPatch), "patches[0] (p) material", "'m'"},
      {With(kCard + kCard + kPatch), "materials[1] (m)", "taken"},
      {With("materials { name: 'm' }" + kPatch), "materials[0] (m)", "no model"},
      {With("materials { name: 'm' lambert { color { r: 1.5 } } }" + kPatch), "lambert color r",
       "1.5"},
      {With("materials { name: 'm' lambert { color { g: nan } } }" + kPatch), "lambert color g",
       "nan"},
      {With("materials { name: 'm' hdrp_lit { smoothness: 2 } }" + kPatch), "hdrp_lit smoothness",
       "is 2"},
      {With("materials { name: 'm' phong { exponent: 0.5 } }" + kPatch), "phong exponent", "0.5"},
      {With("materials { name: 'm' cook_torrance { roughness: 0 f0 {} } }" + kPatch),
       "cook_torrance roughness", "above 0"},
      {With("materials { name: 'm' cook_torrance { roughness: 1 } }" + kPatch), "cook_torrance",
       "refractive_index"},
      {With("materials { name: 'm' standard { smoothness: 1 } }" + kPatch), "materials[0] (m)",
       "hdrp_lit"},
      {With(kCard + "lights { name: 'l' }" + kPatch), "lights[0] (l)", "no kind"},
      {With(kCard + "lights { name: 'l' directional { intensity: -1 } }" + kPatch),
       "directional intensity", "-1"},
      {With(kCard + "lights { name: 'l' directional { towards {} } }" + kPatch),
       "directional towards", "nowhere"},
      {With(kCard + "lights { name: 'l' point {} }" + kPatch), "lights[0] (l) point", "candela"},
      {With(kCard +
            "lights { name: 'l' spot { source { lumen: 1 } axis { x: 1 } "
            "outer_angle_deg: 180 } }" +
            kPatch),
       "outer_angle_deg", "angle"},
      {With(lit + sun + kPatch), "patches[0] (p)", "eye_position_m"},
      {With(lit + sun + "eye_position_m { z: 1 }" + kPatch), "patches[0] (p)", "back"},
      {With(kCard + kPatch + "pass_through { ev: 1 }"), "camera_calibration_constant", "above 0"},
      {With(kCard + kPatch + "pass_through { camera_calibration_constant: 1 ccm: 1 }"),
       "pass_through ccm", "give 9"},
      {With(kCard + kPatch + "pass_through { camera_calibration_constant: 1 bits: 17 }"),
       "pass_through bits", "17"},
      {"renderer: SCENE_RENDERER_URP exposure_ev: 1\n" + kCard + kPatch, "exposure_ev", "HDRP"},
      {"renderer: SCENE_RENDERER_BUILT_IN_GAMMA cube_file: 'a.cube'\n" + kCard + kPatch,
       "cube_file", "HDRP"},
  };
  for (const Wrong& wrong : table) {
    const auto input = ParseScene(wrong.text, "s.textproto");
    ASSERT_FALSE(input.ok()) << wrong.text;
    EXPECT_EQ(input.status().code(), absl::StatusCode::kInvalidArgument);
    const std::string message(input.status().message());
    EXPECT_THAT(message, HasSubstr("s.textproto"));
    EXPECT_THAT(message, HasSubstr(wrong.where)) << wrong.text;
    EXPECT_THAT(message, HasSubstr(wrong.what)) << wrong.text;
  }
}

TEST(SceneFileTest, AbsentFileIsMissing) {
  EXPECT_EQ(ReadScene("no/such.textproto").status().code(), absl::StatusCode::kNotFound);
}

}  // namespace
}  // namespace eyebox::service
