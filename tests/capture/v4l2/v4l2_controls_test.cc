#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "capture/camera/v4l2/v4l2_camera.h"
#include "tests/capture/v4l2/fake_video_device.h"

namespace eyebox::capture {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class V4l2Controls : public testing::Test {
 protected:
  absl::Status Configure(const std::string& options = "") {
    auto camera = OpenV4l2Camera("v4l2:/dev/video0" + options, &device_.clock, &device_);
    if (!camera.ok()) return camera.status();
    camera_ = *std::move(camera);
    return camera_->Configure({.exposure_s = 0.005}).status();
  }

  int32_t ValueOf(uint32_t id) { return device_.controls.at(id).value; }

  FakeVideoDevice device_;
  std::unique_ptr<Camera> camera_;
};

TEST_F(V4l2Controls, HaveEverythingAutomaticSwitchedOff) {
  const absl::Status status = Configure();
  ASSERT_TRUE(status.ok()) << status;
  EXPECT_EQ(ValueOf(V4L2_CID_EXPOSURE_AUTO), V4L2_EXPOSURE_MANUAL);
  EXPECT_EQ(ValueOf(V4L2_CID_EXPOSURE_AUTO_PRIORITY), 0);
  EXPECT_EQ(ValueOf(V4L2_CID_AUTOGAIN), 0);
  EXPECT_EQ(ValueOf(V4L2_CID_AUTO_WHITE_BALANCE), 0);
  EXPECT_EQ(ValueOf(V4L2_CID_BACKLIGHT_COMPENSATION), 0);
  EXPECT_EQ(ValueOf(V4L2_CID_POWER_LINE_FREQUENCY), V4L2_CID_POWER_LINE_FREQUENCY_DISABLED);
  EXPECT_EQ(ValueOf(V4L2_CID_BRIGHTNESS), 0);  // its default
}

class V4l2StuckControl : public V4l2Controls, public testing::WithParamInterface<uint32_t> {};

TEST_P(V4l2StuckControl, IsNamed) {
  FakeControl& control = device_.controls.at(GetParam());
  control.stuck = true;
  const absl::Status status = Configure();
  ASSERT_TRUE(absl::IsUnavailable(status)) << status;
  EXPECT_THAT(std::string(status.message()),
              AllOf(HasSubstr("'" + control.name + "'"), HasSubstr("stays at")));
  EXPECT_TRUE(absl::IsFailedPrecondition(camera_->Start())) << "half a state is none";
}

INSTANTIATE_TEST_SUITE_P(Automatics, V4l2StuckControl,
                         testing::Values(V4L2_CID_EXPOSURE_AUTO, V4L2_CID_EXPOSURE_AUTO_PRIORITY,
                                         V4L2_CID_AUTOGAIN, V4L2_CID_AUTO_WHITE_BALANCE,
                                         V4L2_CID_BACKLIGHT_COMPENSATION,
                                         V4L2_CID_POWER_LINE_FREQUENCY));

TEST_F(V4l2Controls, ThatCannotBeWrittenAreNamed) {
  device_.controls[V4L2_CID_EXPOSURE_AUTO].minimum = 2;  // takes shutter and aperture priority only
  const absl::Status status = Configure();
  ASSERT_TRUE(absl::IsUnavailable(status)) << status;
  EXPECT_THAT(std::string(status.message()), HasSubstr("'Auto Exposure' to 1"));
}

TEST_F(V4l2Controls, MayBeMissing) {
  for (const uint32_t id : {V4L2_CID_EXPOSURE_AUTO, V4L2_CID_AUTOGAIN, V4L2_CID_GAIN}) {
    device_.controls.erase(id);
  }
  const absl::Status status = Configure();
  EXPECT_TRUE(status.ok()) << status;
}

TEST_F(V4l2Controls, MustTellExposureInUnitsOfTime) {
  device_.controls.erase(V4L2_CID_EXPOSURE_ABSOLUTE);
  const absl::Status status = Configure();
  ASSERT_TRUE(absl::IsUnavailable(status)) << status;
  EXPECT_THAT(std::string(status.message()), HasSubstr("V4L2_CID_EXPOSURE_ABSOLUTE"));
}

TEST_F(V4l2Controls, PreferTheAnalogueGainAndLeaveTheOtherAtItsMinimum) {
  device_.controls[V4L2_CID_ANALOGUE_GAIN] = {"Analogue Gain", 0, 480, 7, 0};
  const absl::Status status = Configure("?gain_db_per_step=0.1");
  ASSERT_TRUE(status.ok()) << status;
  ASSERT_TRUE(camera_->Configure({.exposure_s = 0.005, .gain_db = 12}).ok());
  EXPECT_EQ(ValueOf(V4L2_CID_ANALOGUE_GAIN), 120);
  EXPECT_EQ(ValueOf(V4L2_CID_GAIN), 10);
}

TEST_F(V4l2Controls, AskForALinearGammaThatTheDriverDoesNotDefine) {
  device_.controls[V4L2_CID_GAMMA] = {"Gamma", 72, 500, 220, 220};
  const absl::Status status = Configure();
  ASSERT_TRUE(absl::IsInvalidArgument(status)) << status;
  EXPECT_THAT(std::string(status.message()), HasSubstr("gamma=VALUE"));
  ASSERT_TRUE(Configure("?gamma=110").ok());
  EXPECT_EQ(ValueOf(V4L2_CID_GAMMA), 110);
}

TEST_F(V4l2Controls, KnowTheLinearGammaOfAUsbCamera) {
  device_.driver = "uvcvideo";
  device_.controls[V4L2_CID_GAMMA] = {"Gamma", 72, 500, 220, 220};
  const absl::Status status = Configure();
  ASSERT_TRUE(status.ok()) << status;
  EXPECT_EQ(ValueOf(V4L2_CID_GAMMA), 100);
  device_.controls[V4L2_CID_GAMMA].stuck = true;
  device_.controls[V4L2_CID_GAMMA].value = 220;
  EXPECT_THAT(std::string(Configure().message()), HasSubstr("'Gamma'"));
}

TEST_F(V4l2Controls, SetABlackLevelWithinItsLimits) {
  ASSERT_TRUE(Configure().ok());
  const auto set = camera_->Configure({.exposure_s = 0.005, .black_level = -20});
  ASSERT_TRUE(set.ok()) << set.status();
  EXPECT_EQ(set->black_level, -20);
  EXPECT_EQ(ValueOf(V4L2_CID_BRIGHTNESS), -20);
  EXPECT_TRUE(absl::IsInvalidArgument(
      camera_->Configure({.exposure_s = 0.005, .black_level = 65}).status()));
}

TEST_F(V4l2Controls, RefuseABlackLevelThatTheyDoNotHave) {
  device_.controls.erase(V4L2_CID_BRIGHTNESS);
  ASSERT_TRUE(Configure().ok());
  const auto set = camera_->Configure({.exposure_s = 0.005, .black_level = 0}).status();
  ASSERT_TRUE(absl::IsInvalidArgument(set)) << set;
  EXPECT_THAT(std::string(set.message()), HasSubstr("no such control"));
}

TEST_F(V4l2Controls, ThatChangedBetweenConfigureAndStartEndTheCapture) {
  ASSERT_TRUE(Configure().ok());
  device_.controls[V4L2_CID_AUTOGAIN].value = 1;
  ASSERT_TRUE(camera_->Start().ok());
  ASSERT_TRUE(camera_->Trigger().ok());
  const absl::Status status = camera_->NextFrame(std::chrono::milliseconds(100)).status();
  ASSERT_TRUE(absl::IsUnavailable(status)) << status;
  EXPECT_THAT(std::string(status.message()), HasSubstr("'Gain, Automatic'"));
}

TEST_F(V4l2Controls, ThatAreSetAnewAreNotHeldAgainstTheNextCapture) {
  ASSERT_TRUE(Configure().ok());
  ASSERT_TRUE(camera_->Start().ok());
  ASSERT_TRUE(camera_->Stop().ok());
  ASSERT_TRUE(camera_->Configure({.exposure_s = 0.008}).ok());
  ASSERT_TRUE(camera_->Start().ok());
  ASSERT_TRUE(camera_->Trigger().ok());
  const auto frame = camera_->NextFrame(std::chrono::milliseconds(100));
  EXPECT_TRUE(frame.ok()) << frame.status();
}

TEST_F(V4l2Controls, ThatChangeWhileFramesAreTakenEndTheCapture) {
  ASSERT_TRUE(Configure().ok());
  ASSERT_TRUE(camera_->Start().ok());
  ASSERT_TRUE(camera_->Trigger().ok());
  v4l2_event event = {};
  event.type = V4L2_EVENT_CTRL;
  event.id = V4L2_CID_EXPOSURE_ABSOLUTE;
  event.u.ctrl.changes = V4L2_EVENT_CTRL_CH_VALUE;
  event.u.ctrl.value = 400;
  device_.events.push_back(event);
  const absl::Status status = camera_->NextFrame(std::chrono::milliseconds(100)).status();
  ASSERT_TRUE(absl::IsUnavailable(status)) << status;
  EXPECT_THAT(std::string(status.message()),
              AllOf(HasSubstr("'Exposure Time, Absolute'"), HasSubstr("400 instead of 50")));
}

}  // namespace
}  // namespace eyebox::capture
