// From a scene file to what the display shows.
#include "service/scene/predict_scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "capture/base/file.h"
#include "optics/render/srgb.h"
#include "service/result_json.h"
#include "tests/support/temporary_folder.h"

namespace eyebox::service {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

constexpr char kExample[] = EYEBOX_SOURCE_DIR "/fixtures/scenes/hdrp.textproto";

v1::ScenePrediction Predicted(const std::string& text, const std::string& activation = "") {
  const TemporaryFolder folder;
  SceneRequest request{folder / "s.textproto", {}};
  EXPECT_TRUE(WriteFileAtomically(request.scene, text).ok());
  if (!activation.empty()) {
    request.activation = folder / "fit.json";
    EXPECT_TRUE(WriteFileAtomically(request.activation, activation).ok());
  }
  const auto result = PredictScene(request);
  EXPECT_TRUE(result.ok()) << result.status();
  return result.ok() ? *result : v1::ScenePrediction();
}

// L0 = 0.5 +- 0.1, L1 = 100 +- 1, gamma 2 +- 0, uncorrelated.
constexpr char kActivation[] = R"({"parameters": [
  {"name": "minimum_luminance", "value": 0.5, "sigma": 0.1},
  {"name": "luminance_range", "value": 100, "sigma": 1},
  {"name": "cutoff_drive", "value": 0, "sigma": 0}, {"name": "gamma", "value": 2, "sigma": 0}],
  "model": "power_offset", "luminance_unit": "cd/m2",
  "covariance": [0.01, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]})";

constexpr char kGammaMode[] = R"(
  renderer: SCENE_RENDERER_BUILT_IN_GAMMA
  materials { name: "grey" lambert { color { r: 0.6 g: 0.6 b: 0.6 } } }
  materials { name: "red" unlit { color { r: 1 } } }
  lights { name: "sun" directional { intensity: 1 } }
  patches { name: "front" material: "grey" }
  patches { name: "slanted" material: "grey" normal { x: 1.7320508075688772 z: -1 } }
  patches { name: "sign" material: "red" })";

TEST(PredictSceneTest, LuminanceCarriesTheSigmaOfTheActivation) {
  const auto result = Predicted(kGammaMode, kActivation);
  ASSERT_EQ(result.patches_size(), 3);
  const v1::PatchPrediction& front = result.patches(0);
  EXPECT_DOUBLE_EQ(front.v(0), 0.6);
  EXPECT_NEAR(front.luminance().value(), 36.5, 1e-9);
  EXPECT_NEAR(front.luminance().sigma(), std::sqrt(0.01 + 0.36 * 0.36), 1e-9);
  EXPECT_EQ(front.luminance().unit(), "cd/m2");
  // cos 60, stored as 76.5 rounded.
  EXPECT_NEAR(result.patches(1).u(0), 0.3, 1e-15);
  EXPECT_NEAR(result.patches(1).v(0) * 255, std::round(result.patches(1).v(0) * 255), 1e-12);
  EXPECT_NEAR(result.patches(1).v(0), 0.3, 0.5 / 255 + 1e-12);
}

TEST(PredictSceneTest, ColouredDriveHasNoLuminanceAndSaysWhy) {
  const auto result = Predicted(kGammaMode, kActivation);
  EXPECT_FALSE(result.patches(2).has_luminance());
  EXPECT_THAT(result.patches(2).left_out(), Contains(HasSubstr("activation is that of grey")));
}

TEST(PredictSceneTest, OnlyWhatTheSceneNeedsIsEvaluated) {
  const auto result = PredictScene({kExample, {}});
  ASSERT_TRUE(result.ok()) << result.status();
  EXPECT_THAT(result->patches(0).evaluated(), ElementsAre("material colour"));
  EXPECT_THAT(result->patches(0).left_out(), Contains(HasSubstr("light sun: not asked for")));
  EXPECT_THAT(result->patches(1).evaluated(), Contains("light sky"));
  EXPECT_THAT(result->patches(1).evaluated(), Not(Contains("specular")));
  EXPECT_THAT(result->patches(1).left_out(), Contains(HasSubstr("light backlight: below")));
  EXPECT_THAT(result->patches(3).evaluated(), Contains("specular"));
  EXPECT_THAT(result->patches(3).evaluated(), Contains("direction of the eye"));
  EXPECT_THAT(result->unused_lights(), ElementsAre("backlight"));
}

TEST(PredictSceneTest, UnlitColourArrivesThroughBuffersAndTable) {
  const auto result = PredictScene({kExample, {}});
  ASSERT_TRUE(result.ok());
  EXPECT_DOUBLE_EQ(result->patches(0).u(0), optics::SrgbToLinear(0.5));
  // Truncated to 6 bits of mantissa twice, and interpolated in LogC in between.
  EXPECT_NEAR(result->patches(0).v(0), 0.5, 1.0 / 255);
}

TEST(PredictSceneTest, MatchingExposureShowsFilmedLuminanceAsOne) {
  // 2^3 0.25 = 2 cd/m2 saturates the video; an ambient light of 2 on white is as bright.
  const auto result = Predicted(R"(
    renderer: SCENE_RENDERER_HDRP
    rendering_constant: 0.8
    materials { name: "white" hdrp_lit { base_color { r: 1 g: 1 b: 1 } metallic: 1 } }
    lights { name: "sky" ambient { intensity: 2 } }
    eye_position_m { z: -1 }
    patches { name: "p" material: "white" }
    pass_through { ev: 3 camera_calibration_constant: 0.25 match_exposure: true })");
  ASSERT_EQ(result.patches_size(), 1);
  EXPECT_NEAR(result.patches(0).u(0), 1, 1e-9);
  EXPECT_EQ(result.parameters(2).name(), "saturating_luminance");
  EXPECT_DOUBLE_EQ(result.parameters(2).value(), 2);
  EXPECT_EQ(result.patches(0).balanced_code_size(), 3);
}

TEST(PredictSceneTest, ActivationWithoutItsCovarianceIsRefused) {
  const TemporaryFolder folder;
  std::string text = kActivation;
  text.replace(text.find("[0.01"), text.size() - 1 - text.find("[0.01"), "[1]");
  ASSERT_TRUE(WriteFileAtomically(folder / "fit.json", text).ok());
  const auto result = PredictScene({kExample, folder / "fit.json"});
  EXPECT_EQ(result.status().code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(std::string(result.status().message()), HasSubstr("covariance"));
}

}  // namespace
}  // namespace eyebox::service
