#include "capture/camera/sim/sim_rig.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <vector>

#include "capture/base/file.h"
#include "capture/base/npy.h"
#include "capture/camera/sim/display.h"
#include "capture/camera/sim/scene.h"
#include "capture/camera/sim/truth.h"

namespace eyebox::capture {
namespace {

using testing::HasSubstr;

constexpr std::chrono::milliseconds kTimeout(100);

CaptureSpec Grey(double drive) {
  CaptureSpec spec;
  spec.stimulus.drive = DriveRgb{drive, drive, drive};
  spec.exposure_s = 0.0125;
  return spec;
}

CaptureSpec Flat(double luminance_cd_m2) {
  CaptureSpec spec;
  spec.kind = FrameKind::kFlat;
  spec.luminance_cd_m2 = luminance_cd_m2;
  spec.exposure_s = 0.0125;
  return spec;
}

class SimRig : public testing::Test {
 protected:
  Rig Open(uint64_t seed, const std::string& uri = "sim:rift-s-like") {
    const RigConfig config = {.name = "test", .camera_uri = uri, .seed = seed};
    const auto parameters = SimParametersOf(config);
    EXPECT_TRUE(parameters.ok()) << parameters.status();
    auto rig = OpenSimRig(config, *parameters, &clock_);
    EXPECT_TRUE(rig.ok()) << rig.status();
    return *std::move(rig);
  }

  // Presents and takes `count` frames.
  std::vector<Frame> Take(Rig& rig, const CaptureSpec& spec, int count = 1) {
    EXPECT_TRUE(rig.presenter->Present(spec).ok());
    EXPECT_TRUE(rig.camera->Stop().ok());
    EXPECT_TRUE(rig.camera->Configure({.exposure_s = spec.exposure_s}).ok());
    EXPECT_TRUE(rig.camera->Start().ok());
    std::vector<Frame> frames;
    for (int i = 0; i < count; ++i) {
      EXPECT_TRUE(rig.camera->Trigger().ok());
      auto frame = rig.camera->NextFrame(kTimeout);
      EXPECT_TRUE(frame.ok()) << frame.status();
      frames.push_back(*std::move(frame));
    }
    return frames;
  }

  static std::vector<uint16_t> Counts(const Frame& frame) {
    return {frame.view.pixels_dn.begin(), frame.view.pixels_dn.end()};
  }

  ManualClock clock_{1000, 2000};
};

TEST_F(SimRig, SameSeedGivesTheSameFrames) {
  Rig first = Open(5);
  Rig second = Open(5);
  for (const CaptureSpec& spec : {Grey(0.5), Flat(9), Grey(0.5)}) {
    const auto a = Take(first, spec, 2);
    clock_.AdvanceNs(12345678);
    const auto b = Take(second, spec, 2);
    EXPECT_EQ(Counts(a[0]), Counts(b[0]));
    EXPECT_EQ(Counts(a[1]), Counts(b[1]));
  }
}

TEST_F(SimRig, AnotherSeedCaptureOrExposureGivesOtherNoise) {
  Rig rig = Open(5);
  Rig other = Open(6);
  const auto frames = Take(rig, Grey(0.5), 2);
  EXPECT_NE(Counts(frames[0]), Counts(frames[1]));
  EXPECT_NE(Counts(frames[0]), Counts(Take(rig, Grey(0.5))[0]));
  EXPECT_NE(Counts(frames[0]), Counts(Take(other, Grey(0.5))[0]));
}

TEST_F(SimRig, NoiseDoesNotDependOnWhenFramesAreFetched) {
  Rig rig = Open(5);
  Rig queued = Open(5);
  const auto frames = Take(rig, Grey(0.5), 2);
  ASSERT_TRUE(queued.presenter->Present(Grey(0.5)).ok());
  ASSERT_TRUE(queued.camera->Configure({.exposure_s = 0.0125}).ok());
  ASSERT_TRUE(queued.camera->Start().ok());
  ASSERT_TRUE(queued.camera->Trigger().ok());
  ASSERT_TRUE(queued.camera->Trigger().ok());
  ASSERT_TRUE(queued.presenter->Present(Grey(1)).ok());
  EXPECT_EQ(Counts(*queued.camera->NextFrame(kTimeout)), Counts(frames[0]));
  EXPECT_EQ(Counts(*queued.camera->NextFrame(kTimeout)), Counts(frames[1]));
}

TEST_F(SimRig, NothingPresentedIsDark) {
  Rig rig = Open(5);
  ASSERT_TRUE(rig.camera->Configure({.exposure_s = 0.01}).ok());
  ASSERT_TRUE(rig.camera->Start().ok());
  ASSERT_TRUE(rig.camera->Trigger().ok());
  const auto frame = rig.camera->NextFrame(kTimeout);
  ASSERT_TRUE(frame.ok());
  double sum_dn = 0;
  for (const uint16_t count : frame->view.pixels_dn) sum_dn += count;
  EXPECT_NEAR(sum_dn / 19200, 64, 0.1);
}

TEST_F(SimRig, RefusesAFlatOfUnknownLuminance) {
  Rig rig = Open(5);
  CaptureSpec flat = Flat(9);
  flat.luminance_cd_m2.reset();
  const absl::Status status = rig.presenter->Present(flat);
  EXPECT_TRUE(absl::IsInvalidArgument(status));
  EXPECT_THAT(std::string(status.message()), HasSubstr("luminance_cd_m2"));
}

TEST_F(SimRig, StatesItsGeometryAndThatItIsSimulated) {
  const Rig rig = Open(5);
  EXPECT_EQ(rig.origin, RecordingOrigin::kSimulated);
  ASSERT_TRUE(rig.camera->Info().geometry.has_value());
  const double half_field_deg =
      std::atan(80 / rig.camera->Info().geometry->focal_length_px) * 180 / M_PI;
  EXPECT_NEAR(2 * half_field_deg, 40, 0.01);
}

TEST(SceneRate, LightIsWhatReductionTakesApart) {
  SimParameters parameters;
  parameters.scatter.core_sigma_px = 0;
  parameters.scatter.tail_weight = 0;
  const FixedPattern pattern = MakeFixedPattern(parameters.sensor, 1);
  const auto light = SceneRate(parameters, pattern, Grey(0.7));
  const auto flat = SceneRate(parameters, pattern, Flat(9));
  ASSERT_TRUE(light.ok() && flat.ok());
  const Image<double> g = Nonuniformity(parameters.nonuniformity, parameters.sensor.size);
  const double luminance = DisplayLuminance(parameters.display, {0.7, 0.7, 0.7});
  for (const auto& [x, y] : {std::pair{0, 0}, {80, 60}, {159, 3}}) {
    EXPECT_NEAR(9 * light->at(x, y) / flat->at(x, y), luminance * g.at(x, y), 1e-10);
  }
}

TEST(SceneRate, WhiteFillsThreeQuartersOfTheWellInTheShortestDefaultExposure) {
  const SimParameters parameters;
  const FixedPattern pattern = MakeFixedPattern(parameters.sensor, 1);
  const auto rate = SceneRate(parameters, pattern, Grey(1));
  ASSERT_TRUE(rate.ok());
  EXPECT_NEAR(rate->at(80, 60) * 0.0125 / parameters.sensor.full_well_e, 0.73, 0.03);
}

TEST(SimParameters, OfEveryNameAreValid) {
  for (const std::string& name : SimNames()) {
    const auto parameters = NamedSimParameters(name);
    ASSERT_TRUE(parameters.ok()) << parameters.status();
    EXPECT_TRUE(parameters->Validate().ok()) << parameters->Validate();
    EXPECT_EQ(parameters->name, name);
  }
}

TEST(SimParameters, OfAnUnknownNameListTheKnownOnes) {
  const absl::Status status = NamedSimParameters("quest").status();
  EXPECT_TRUE(absl::IsInvalidArgument(status));
  EXPECT_THAT(std::string(status.message()), HasSubstr("sim:rift-s-like-cutoff"));
}

TEST(SimParameters, OutOfRangeAreRefusedByName) {
  SimParameters parameters;
  parameters.sensor.gain_dn_per_e = 0;
  EXPECT_THAT(std::string(parameters.Validate().message()), HasSubstr("sensor.gain_dn_per_e"));
  parameters = {};
  parameters.display.channels[0].luminance_weight = 0.5;
  EXPECT_THAT(std::string(parameters.Validate().message()), HasSubstr("luminance_weight"));
  parameters = {};
  parameters.scatter.tail_weight = std::nan("");
  EXPECT_THAT(std::string(parameters.Validate().message()), HasSubstr("scatter.tail_weight"));
}

class Truth : public testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove_all(folder_); }
  const std::filesystem::path folder_ =
      std::filesystem::path(testing::TempDir()) / "eyebox_sim_truth";
};

TEST_F(Truth, IsWrittenAsJsonAndAMap) {
  const RigConfig config = {.name = "t", .camera_uri = "sim:rift-s-like-cutoff", .seed = 3};
  ASSERT_TRUE(WriteSimTruth(folder_, config).ok());
  const auto json = ReadWholeFile(folder_ / "truth.json");
  ASSERT_TRUE(json.ok()) << json.status();
  for (const char* member : {"\"simulated\": true", "\"gamma\": 2.3", "\"cutoff_drive\": 0.03",
                             "\"minimum_luminance_cd_m2\": 0.19", "\"gain_dn_per_e\": 0.2",
                             "\"luminance_range_cd_m2\": 58.81", "\"seed\": 3"}) {
    EXPECT_THAT(*json, HasSubstr(member));
  }
  const auto g = ReadNpy(folder_ / "truth_g.npy");
  ASSERT_TRUE(g.ok()) << g.status();
  EXPECT_EQ(g->size(), (ImageSize{.width_px = 160, .height_px = 120}));
  EXPECT_NEAR(g->at(80, 60), 1, 1e-3);
}

TEST_F(Truth, NamesNoCommonGammaWhereChannelsDiffer) {
  SimParameters parameters;
  parameters.display.channels[2].gamma = 2.1;
  const std::string json = SimTruthJson(MakeSimTruth(parameters, 1));
  EXPECT_THAT(json, testing::Not(HasSubstr("\n  \"gamma\"")));
  EXPECT_THAT(json, HasSubstr("\n  \"cutoff_drive\""));
  EXPECT_THAT(json, HasSubstr("      \"gamma\": 2.1"));
}

TEST_F(Truth, OfARigThatIsNotSimulatedIsRefused) {
  EXPECT_TRUE(absl::IsInvalidArgument(
      WriteSimTruth(folder_, {.name = "t", .camera_uri = "replay:somewhere"})));
}

}  // namespace
}  // namespace eyebox::capture
