#include "capture/camera/v4l2/v4l2_camera.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>

#include "tests/capture/v4l2/fake_video_device.h"

namespace eyebox::capture {
namespace {

using std::chrono::milliseconds;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr CameraSettings kShort = {.exposure_s = 0.005, .gain_db = 0};

class V4l2CameraTest : public testing::Test {
 protected:
  void Open(const std::string& uri = "v4l2:/dev/video0") {
    auto camera = OpenV4l2Camera(uri, &device_.clock, &device_);
    ASSERT_TRUE(camera.ok()) << camera.status();
    camera_ = *std::move(camera);
  }

  void Run(const CameraSettings& settings = kShort) {
    ASSERT_TRUE(camera_->Configure(settings).ok());
    ASSERT_TRUE(camera_->Start().ok());
  }

  // Every pixel of a frame of the device carries the ordinal of the frame.
  void NumberFrames() {
    device_.draw = [](uint32_t frame, std::span<uint8_t> bytes) {
      for (size_t i = 0; i < bytes.size(); i += 2) {
        bytes[i] = static_cast<uint8_t>(frame);
        bytes[i + 1] = 0;
      }
    };
  }

  FakeVideoDevice device_;
  std::unique_ptr<Camera> camera_;
};

TEST_F(V4l2CameraTest, ChoosesTheDeepestFormatAtItsLargestSize) {
  Open();
  EXPECT_EQ(device_.fourcc(), V4L2_PIX_FMT_Y12);
  EXPECT_EQ(camera_->Info().significant_bits, 12);
  EXPECT_EQ(camera_->Info().sensor_size, (ImageSize{.width_px = 6, .height_px = 4}));
  EXPECT_EQ(camera_->Info().model, "Fake camera");
  EXPECT_EQ(camera_->Info().pixel_format, "Mono12");
}

TEST_F(V4l2CameraTest, StatesExposureLimitsInSecondsWithinTheLongestFrameInterval) {
  Open();
  EXPECT_DOUBLE_EQ(camera_->Info().exposure_min_s, 1e-4);
  EXPECT_DOUBLE_EQ(camera_->Info().exposure_max_s, 0.1);  // the control would go to 0.5 s
  EXPECT_TRUE(absl::IsInvalidArgument(camera_->Configure({.exposure_s = 0.2}).status()));
}

TEST_F(V4l2CameraTest, ReturnsTheExposureThatReadsBack) {
  Open();
  const auto set = camera_->Configure({.exposure_s = 0.01234});
  ASSERT_TRUE(set.ok()) << set.status();
  EXPECT_DOUBLE_EQ(set->exposure_s, 0.0123);  // whole units of 100 us
  EXPECT_EQ(device_.controls[V4L2_CID_EXPOSURE_ABSOLUTE].value, 123);
}

TEST_F(V4l2CameraTest, RunsAsFastAsTheExposureAllows) {
  Open();
  ASSERT_TRUE(camera_->Configure({.exposure_s = 0.01}).ok());
  EXPECT_EQ(device_.interval_ms(), 10);
  ASSERT_TRUE(camera_->Configure({.exposure_s = 0.011}).ok());
  EXPECT_EQ(device_.interval_ms(), 100);
}

TEST_F(V4l2CameraTest, KeepsGainAtItsMinimumWhileTheDeviceDoesNotTellItsUnit) {
  Open();
  EXPECT_EQ(camera_->Info().gain_max_db, 0);
  EXPECT_TRUE(
      absl::IsInvalidArgument(camera_->Configure({.exposure_s = 0.01, .gain_db = 1}).status()));
  ASSERT_TRUE(camera_->Configure(kShort).ok());
  EXPECT_EQ(device_.controls[V4L2_CID_GAIN].value, 10);
}

TEST_F(V4l2CameraTest, CountsGainInTheStepsOfTheDataSheet) {
  Open("v4l2:/dev/video0?gain_db_per_step=0.2");
  EXPECT_DOUBLE_EQ(camera_->Info().gain_max_db, 20);
  const auto set = camera_->Configure({.exposure_s = 0.01, .gain_db = 6});
  ASSERT_TRUE(set.ok()) << set.status();
  EXPECT_DOUBLE_EQ(set->gain_db, 6);
  EXPECT_EQ(device_.controls[V4L2_CID_GAIN].value, 40);
}

TEST_F(V4l2CameraTest, AnswersATriggerWithTheNextFrameThatBegan) {
  NumberFrames();
  Open();
  Run();
  device_.clock.AdvanceNs(55000000);  // within frame 5
  ASSERT_TRUE(camera_->Trigger().ok());
  const auto frame = camera_->NextFrame(milliseconds(100));
  ASSERT_TRUE(frame.ok()) << frame.status();
  EXPECT_EQ(frame->metadata.status, BufferStatus::kComplete);
  EXPECT_EQ(frame->metadata.camera_frame_id, 1);
  EXPECT_EQ(frame->metadata.device_time_ns, device_.stream_began_ns() + 60000000);
  EXPECT_EQ(frame->metadata.trigger_time_ns, device_.stream_began_ns() + 55000000);
  EXPECT_GE(frame->metadata.monotonic_time_ns, device_.stream_began_ns() + 70000000);
  EXPECT_EQ(frame->view.pixels_dn.front(), 6);
}

TEST_F(V4l2CameraTest, TellsNoExposureThatTheDeviceDoesNotReportForTheFrame) {
  Open();
  Run();
  ASSERT_TRUE(camera_->Trigger().ok());
  const auto frame = camera_->NextFrame(milliseconds(100));
  ASSERT_TRUE(frame.ok()) << frame.status();
  EXPECT_EQ(frame->metadata.exposure_asked_s, 0.005);
  EXPECT_FALSE(frame->metadata.exposure_reported_s);
  EXPECT_FALSE(frame->metadata.gain_reported_db);
}

TEST_F(V4l2CameraTest, PassesOverTheFrameThatMayShowTheExposureOfBefore) {
  NumberFrames();
  Open();
  Run();
  ASSERT_TRUE(camera_->Trigger().ok());  // before frame 0 begins
  const auto frame = camera_->NextFrame(milliseconds(100));
  ASSERT_TRUE(frame.ok()) << frame.status();
  EXPECT_EQ(frame->view.pixels_dn.front(), 1);
}

TEST_F(V4l2CameraTest, ReckonsBackwardsWhereStampsMarkTheEndOfAFrame) {
  NumberFrames();
  device_.timestamp_flags = V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC | V4L2_BUF_FLAG_TSTAMP_SRC_EOF;
  Open();
  Run();
  device_.clock.AdvanceNs(55000000);
  ASSERT_TRUE(camera_->Trigger().ok());
  const auto frame = camera_->NextFrame(milliseconds(100));
  ASSERT_TRUE(frame.ok()) << frame.status();
  // Exposure and readout took 5 + 10 ms at most: frame 6, which ended at 70 ms, may have begun to
  // integrate at 55 ms, the very moment of the trigger.
  EXPECT_EQ(frame->view.pixels_dn.front(), 6);
}

TEST_F(V4l2CameraTest, NumbersTheFramesOfAStreamWithoutGapHoweverSlowItIsRead) {
  Open();
  Run();
  for (uint64_t id = 1; id <= 20; ++id) {
    device_.clock.AdvanceNs(95000000);  // the ring overflows in between
    ASSERT_TRUE(camera_->Trigger().ok());
    const auto frame = camera_->NextFrame(milliseconds(100));
    ASSERT_TRUE(frame.ok()) << frame.status();
    EXPECT_EQ(frame->metadata.camera_frame_id, id);
  }
}

TEST_F(V4l2CameraTest, HasFramesThatOutliveIt) {
  NumberFrames();
  Open();
  Run();
  ASSERT_TRUE(camera_->Trigger().ok());
  const auto frame = camera_->NextFrame(milliseconds(100));
  ASSERT_TRUE(frame.ok()) << frame.status();
  camera_.reset();
  EXPECT_EQ(device_.mapped_count(), 0);
  EXPECT_EQ(device_.open_count(), 0);
  EXPECT_THAT(frame->view.pixels_dn, testing::Each(1));
}

TEST_F(V4l2CameraTest, StartsAgainAfterAStop) {
  Open();
  for (int i = 0; i < 3; ++i) {
    Run();
    EXPECT_TRUE(absl::IsFailedPrecondition(camera_->Configure(kShort).status()));
    ASSERT_TRUE(camera_->Trigger().ok());
    const auto frame = camera_->NextFrame(milliseconds(100));
    ASSERT_TRUE(frame.ok()) << frame.status();
    EXPECT_EQ(frame->metadata.camera_frame_id, 1);
    ASSERT_TRUE(camera_->Stop().ok());
    EXPECT_EQ(device_.mapped_count(), 0);
  }
}

TEST_F(V4l2CameraTest, IsListedByNumberWithItsRawFormats) {
  const std::filesystem::path folder = testing::TempDir() + "v4l2_listing";
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  for (const char* name : {"video10", "video2", "video", "videoX", "media0"}) {
    std::ofstream(folder / name).put('x');
  }
  const auto listings = ListV4l2Cameras(folder, &device_);
  ASSERT_EQ(listings.size(), 2);
  EXPECT_EQ(listings[0].uri, "v4l2:" + (folder / "video2").string());
  EXPECT_EQ(listings[1].uri, "v4l2:" + (folder / "video10").string());
  EXPECT_EQ(listings[0].card, "Fake camera");
  EXPECT_THAT(listings[0].formats, ElementsAre("GREY", "Y12"));
  EXPECT_EQ(listings[0].problem, "");
  EXPECT_EQ(device_.open_count(), 0);
}

TEST_F(V4l2CameraTest, IsListedWithWhatKeepsItFromBeingUsed) {
  const std::filesystem::path folder = testing::TempDir() + "v4l2_listing_problem";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "video0").put('x');
  device_.fourccs = {V4L2_PIX_FMT_YUYV};
  EXPECT_THAT(ListV4l2Cameras(folder, &device_).at(0).problem, HasSubstr("no raw format"));
  device_.unplugged = true;
  EXPECT_THAT(ListV4l2Cameras(folder, &device_).at(0).problem, HasSubstr("does not exist"));
  EXPECT_TRUE(ListV4l2Cameras(folder / "nothing", &device_).empty());
}

}  // namespace
}  // namespace eyebox::capture
