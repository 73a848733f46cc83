#include <errno.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <string>

#include "capture/camera/v4l2/v4l2_camera.h"
#include "tests/capture/v4l2/fake_video_device.h"

namespace eyebox::capture {
namespace {

using std::chrono::milliseconds;
using testing::HasSubstr;

class V4l2Faults : public testing::Test {
 protected:
  absl::Status Start() {
    auto camera = OpenV4l2Camera("v4l2:/dev/video0", &device_.clock, &device_);
    if (!camera.ok()) return camera.status();
    camera_ = *std::move(camera);
    const auto set = camera_->Configure({.exposure_s = 0.005});
    return set.ok() ? camera_->Start() : set.status();
  }

  absl::StatusOr<Frame> Take(milliseconds timeout = milliseconds(100)) {
    const absl::Status status = camera_->Trigger();
    if (!status.ok()) return status;
    return camera_->NextFrame(timeout);
  }

  void FaultOnly(uint32_t frame, FakeFault fault) {
    device_.fault = [=](uint32_t n) { return n == frame ? fault : FakeFault::kNone; };
  }

  FakeVideoDevice device_;
  std::unique_ptr<Camera> camera_;
};

TEST_F(V4l2Faults, ASpoiltBufferIsNoData) {
  FaultOnly(1, FakeFault::kSpoilt);  // frame 0 is passed over
  ASSERT_TRUE(Start().ok());
  const auto frame = Take();
  ASSERT_TRUE(frame.ok()) << frame.status();
  EXPECT_EQ(frame->metadata.status, BufferStatus::kDeviceError);
  EXPECT_EQ(Take()->metadata.status, BufferStatus::kComplete);
}

TEST_F(V4l2Faults, ABufferCutShortIsNoData) {
  FaultOnly(1, FakeFault::kCutShort);
  ASSERT_TRUE(Start().ok());
  const auto frame = Take();
  ASSERT_TRUE(frame.ok()) << frame.status();
  EXPECT_EQ(frame->metadata.status, BufferStatus::kDeviceError);
  EXPECT_TRUE(frame->view.pixels_dn.empty());
  EXPECT_EQ(frame->view.size, camera_->Info().sensor_size);
}

TEST_F(V4l2Faults, AWantedFrameThatIsLostLeavesAGap) {
  FaultOnly(2, FakeFault::kLost);
  ASSERT_TRUE(Start().ok());
  ASSERT_TRUE(camera_->Trigger().ok());
  ASSERT_TRUE(camera_->Trigger().ok());
  EXPECT_EQ(camera_->NextFrame(milliseconds(100))->metadata.camera_frame_id, 1);
  EXPECT_EQ(camera_->NextFrame(milliseconds(100))->metadata.camera_frame_id, 3);
}

TEST_F(V4l2Faults, AnUnpluggedCameraIsUnavailableAndCanBeStopped) {
  ASSERT_TRUE(Start().ok());
  ASSERT_TRUE(Take().ok());
  device_.unplugged = true;
  const absl::Status status = Take().status();
  ASSERT_TRUE(absl::IsUnavailable(status)) << status;
  EXPECT_THAT(std::string(status.message()), HasSubstr("unplugged"));
  EXPECT_TRUE(camera_->Stop().ok());
  EXPECT_EQ(device_.mapped_count(), 0);
  EXPECT_TRUE(absl::IsUnavailable(camera_->Configure({.exposure_s = 0.005}).status()));
}

TEST_F(V4l2Faults, ASilentCameraTimesOutAndMayGoOn) {
  ASSERT_TRUE(Start().ok());
  device_.silent = true;
  const int64_t began_ns = device_.clock.MonotonicNs();
  EXPECT_TRUE(absl::IsDeadlineExceeded(Take(milliseconds(250)).status()));
  EXPECT_EQ(device_.clock.MonotonicNs() - began_ns, 250000000);
  device_.silent = false;
  const auto frame = Take();
  ASSERT_TRUE(frame.ok()) << frame.status();
  EXPECT_EQ(frame->metadata.trigger_time_ns, began_ns + 250000000);
}

TEST_F(V4l2Faults, FramesOfAnotherClockAreRefused) {
  device_.timestamp_flags = V4L2_BUF_FLAG_TIMESTAMP_UNKNOWN;
  ASSERT_TRUE(Start().ok());
  const absl::Status status = Take().status();
  ASSERT_TRUE(absl::IsUnavailable(status)) << status;
  EXPECT_THAT(std::string(status.message()), HasSubstr("CLOCK_MONOTONIC"));
}

TEST_F(V4l2Faults, CountsBeyondTheFormatAreRefused) {
  device_.draw = [](uint32_t, std::span<uint8_t> bytes) { bytes[1] = 0x10; };  // 4096 in Y12
  ASSERT_TRUE(Start().ok());
  const absl::Status status = Take().status();
  ASSERT_TRUE(absl::IsUnavailable(status)) << status;
  EXPECT_THAT(std::string(status.message()), HasSubstr("above 4095 in Y12"));
}

TEST_F(V4l2Faults, InterruptedCallsAreRepeated) {
  device_.interrupts = true;
  const absl::Status status = Start();
  ASSERT_TRUE(status.ok()) << status;
  for (int i = 0; i < 5; ++i) {
    const auto frame = Take();
    ASSERT_TRUE(frame.ok()) << frame.status();
  }
}

TEST_F(V4l2Faults, AFormatThatTheDriverAltersIsRefused) {
  device_.answers_fourcc = V4L2_PIX_FMT_GREY;
  const absl::Status status = Start();
  ASSERT_TRUE(absl::IsUnavailable(status)) << status;
  EXPECT_THAT(std::string(status.message()), HasSubstr("Y12 6x4 and became GREY 6x4"));
}

TEST_F(V4l2Faults, ASizeThatTheDriverAltersIsRefused) {
  device_.answers_width = 4;
  EXPECT_THAT(std::string(Start().message()), HasSubstr("became Y12 4x4"));
}

TEST_F(V4l2Faults, InterlacedFramesAreRefused) {
  device_.field = V4L2_FIELD_INTERLACED;
  EXPECT_THAT(std::string(Start().message()), HasSubstr("interlaced"));
}

TEST_F(V4l2Faults, RowsTooShortForTheirPixelsAreRefused) {
  device_.row_bytes = 11;
  EXPECT_THAT(std::string(Start().message()), HasSubstr("rows of 11 bytes"));
}

TEST_F(V4l2Faults, ACameraWithoutRawFormatsIsRefused) {
  device_.fourccs = {V4L2_PIX_FMT_YUYV, V4L2_PIX_FMT_MJPEG};
  const absl::Status status = Start();
  ASSERT_TRUE(absl::IsInvalidArgument(status)) << status;
  EXPECT_THAT(std::string(status.message()), HasSubstr("offers nothing raw"));
}

TEST_F(V4l2Faults, AFormatThatIsNotOfferedIsRefusedWithThoseThatAre) {
  const auto camera =
      OpenV4l2Camera("v4l2:/dev/video0?format=Y16", &device_.clock, &device_).status();
  ASSERT_TRUE(absl::IsInvalidArgument(camera)) << camera;
  EXPECT_THAT(std::string(camera.message()), HasSubstr("GREY Y12"));
}

TEST_F(V4l2Faults, ACameraThatTellsNoFrameIntervalIsRefused) {
  device_.intervals_ms = {};
  device_.tells_interval = false;
  EXPECT_THAT(std::string(Start().message()), HasSubstr("frame interval"));
}

TEST_F(V4l2Faults, ABusyCameraIsNamedAsSuch) {
  device_.fails[VIDIOC_REQBUFS] = EBUSY;
  const absl::Status status = Start();
  EXPECT_TRUE(absl::IsResourceExhausted(status)) << status;
  EXPECT_TRUE(absl::IsFailedPrecondition(camera_->Trigger()));
  device_.fails.clear();
  EXPECT_TRUE(camera_->Start().ok());
}

TEST_F(V4l2Faults, AStreamThatDoesNotStartGivesEverythingBack) {
  device_.fails[VIDIOC_STREAMON] = EIO;
  EXPECT_TRUE(absl::IsUnavailable(Start()));
  EXPECT_EQ(device_.mapped_count(), 0);
}

TEST_F(V4l2Faults, ANodeThatIsNoVideoDeviceIsRefused) {
  device_.fails[VIDIOC_QUERYCAP] = ENOTTY;
  EXPECT_TRUE(absl::IsInvalidArgument(Start()));
  EXPECT_EQ(device_.open_count(), 0);
}

TEST_F(V4l2Faults, AMissingNodeIsNotFound) {
  device_.unplugged = true;
  EXPECT_TRUE(absl::IsNotFound(Start()));
}

}  // namespace
}  // namespace eyebox::capture
