// A scene is planned for, captured and run, as a person would.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "capture/recording/plan_file.h"
#include "eyebox/v1/measurement_plan.pb.h"
#include "tests/service/run_eyebox.h"

namespace eyebox::service {
namespace {

using testing::HasSubstr;

constexpr char kUnlit[] = "unlit { color { r: 0.5 g: 0.5 b: 0.5 } }";
constexpr char kLit[] = "hdrp_lit { base_color { r: 0.5 g: 0.5 b: 0.5 } }";

std::string WriteScene(const TemporaryFolder& folder, const std::string& patch,
                       const std::string& material = kLit) {
  const std::string file = folder / "scene.textproto";
  std::ofstream(file) << "renderer: SCENE_RENDERER_HDRP\n"
                         "materials { name: \"grey\" "
                      << material
                      << " }\n"
                         "lights { name: \"sky\" ambient { intensity: 1 } }\n"
                         "eye_position_m { z: -2 }\n"
                         "patches { name: \"patch\" material: \"grey\" "
                      << patch << " }\n";
  return file;
}

TEST(CliPlan, APlanIsCapturedAndRun) {
  const TemporaryFolder folder;
  const std::string scene = WriteScene(folder, "within_deg: 10 diameter_deg: 8");
  const std::string plan = folder / "plan.textproto";
  const auto message = ParsedFrom<v1::MeasurementPlan>(
      RunEyebox("plan --scene " + scene + " --tolerance 2% sim:rift-s-like --json --out " + plan));
  EXPECT_LE(message.parameters(1).value(), 0.02);
  EXPECT_GT(message.parameters(3).value(), 0);
  bool colour_left_out = false;
  bool single_precision = false;
  for (const v1::PlanDecision& decision : message.decisions()) {
    EXPECT_FALSE(decision.reason().empty());
    colour_left_out = colour_left_out || (decision.about() == "colour" && decision.left_out());
    single_precision =
        single_precision || (decision.about() == "precision" && decision.choice() == "single");
  }
  EXPECT_TRUE(colour_left_out);
  EXPECT_TRUE(single_precision);
  const auto read = capture::ReadPlanFile(plan);
  ASSERT_TRUE(read.ok()) << read.status();
  EXPECT_EQ(static_cast<int>(read->captures.size()), message.captures());
  const std::string recording = folder / "recording";
  const Outcome captured =
      RunEyebox("capture sim:rift-s-like --plan " + plan + " --out " + recording);
  EXPECT_EQ(captured.exit_code, 0) << captured.err;
  const Outcome run = RunEyebox("fit " + recording);
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("gamma"));
}

TEST(CliPlan, AToleranceThatSinglePrecisionCouldBreakIsRefused) {
  const TemporaryFolder folder;
  const std::string scene = WriteScene(folder, "within_deg: 10 diameter_deg: 8");
  const Outcome refused = RunEyebox("plan --scene " + scene + " --tolerance 0.0009% sim:ideal");
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_THAT(refused.err, HasSubstr("--tolerance"));
  EXPECT_THAT(refused.err, HasSubstr("0.001 %"));
}

TEST(CliPlan, WhatNeverVariesIsReadItself) {
  const TemporaryFolder folder;
  const std::string scene = WriteScene(folder, "within_deg: 5 diameter_deg: 8", kUnlit);
  const std::string plan = folder / "plan.textproto";
  const Outcome planned =
      RunEyebox("plan --scene " + scene + " --tolerance 2% sim:rift-s-like --out " + plan);
  ASSERT_EQ(planned.exit_code, 0) << planned.err;
  EXPECT_THAT(planned.out, HasSubstr("eyebox reduce RECORDING --series scene-1"));
  const std::string recording = folder / "recording";
  const Outcome captured =
      RunEyebox("capture sim:rift-s-like --plan " + plan + " --out " + recording);
  ASSERT_EQ(captured.exit_code, 0) << captured.err;
  const Outcome reduced = RunEyebox("reduce " + recording + " --series scene-1");
  EXPECT_EQ(reduced.exit_code, 0) << reduced.err;
  EXPECT_THAT(reduced.out, HasSubstr("at_centre"));
}

TEST(CliPlan, WhatCannotBeKeptIsRefusedWithAnOffer) {
  const TemporaryFolder folder;
  const std::string scene = WriteScene(folder, "");
  const Outcome tight =
      RunEyebox("plan --scene " + scene + " --tolerance 0.2% --budget 1.5s sim:rift-s-like");
  EXPECT_EQ(tight.exit_code, 5) << tight.out;
  EXPECT_THAT(tight.err, HasSubstr("a tolerance of 0.2 % is not kept within 1.5 s"));
  const Outcome device = RunEyebox("plan --scene " + scene + " v4l2:/dev/video9");
  EXPECT_NE(device.exit_code, 0);
  EXPECT_THAT(device.err, HasSubstr("--pilot PILOT"));
  const Outcome tolerance = RunEyebox("plan --scene " + scene + " --tolerance x sim:ideal");
  EXPECT_EQ(tolerance.exit_code, 3);
  EXPECT_THAT(tolerance.err, HasSubstr("--tolerance"));
}

TEST(CliPlan, APlanThatIsWrongNamesItsCapture) {
  const TemporaryFolder folder;
  const std::string file = folder / "plan.textproto";
  std::ofstream(file) << "captures { kind: FRAME_KIND_LIGHT repeats: -1 exposure_s: 0.1 }\n";
  const Outcome outcome =
      RunEyebox("capture sim:ideal --plan " + file + " --out " + std::string(folder / "recording"));
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_THAT(outcome.err, HasSubstr("captures[0]"));
}

}  // namespace
}  // namespace eyebox::service
