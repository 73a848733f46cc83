// The Aravis camera on arv-fake-gv-camera-0.8: GigE Vision with real packets, over loopback.
#include <arv.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <numeric>
#include <string>

#include "capture/camera/aravis/aravis_rig.h"
#include "capture/plan.h"
#include "capture/run.h"
#include "tests/capture/camera/aravis_fake_process.h"
#include "tests/support/memory_recording.h"

namespace eyebox::capture {
namespace {

using std::chrono::milliseconds;
using testing::HasSubstr;

constexpr milliseconds kTimeout{10000};  // never waited for where all is well
constexpr const char* kMono8 = "?pixel_format=Mono8&region=512x512+0+0";

class AravisLoopback : public testing::Test {
 protected:
  void SetUp() override {
    std::string why_not;
    ASSERT_TRUE(EnterPrivateNetwork(why_not)) << why_not;
  }

  void StartCamera(int lost_packets_per_thousand = 0) {
    process_ = FakeGigECamera::Start("T1", lost_packets_per_thousand);
    ASSERT_NE(process_, nullptr) << "is aravis-tools installed?";
  }

  absl::StatusOr<Rig> OpenRig(const std::string& options) {
    return OpenAravisRig({.name = "test", .camera_uri = process_->uri() + options}, SystemClock());
  }

  std::unique_ptr<Camera> Open(const std::string& options = kMono8) {
    auto rig = OpenRig(options);
    EXPECT_TRUE(rig.ok()) << rig.status();
    return rig.ok() ? std::move(rig->camera) : nullptr;
  }

  std::unique_ptr<FakeGigECamera> process_;
};

absl::StatusOr<Frame> TakeFrame(Camera& camera) {
  if (absl::Status triggered = camera.Trigger(); !triggered.ok()) return triggered;
  return camera.NextFrame(kTimeout);
}

// Aravis' own ramp at 10 ms: (x + y + id) modulo 255.
bool IsRamp(const Frame& frame) {
  const auto [width, height] = frame.view.size;
  if (frame.view.pixels_dn.size() != frame.view.size.PixelCount()) return false;
  const uint64_t id = (frame.metadata.camera_frame_id - 1) % 65535 + 1;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      if (frame.view.pixels_dn[static_cast<size_t>(y) * width + x] != (x + y + id) % 255) {
        return false;
      }
    }
  }
  return true;
}

double Mean(const Frame& frame) {
  const auto pixels = frame.view.pixels_dn;
  return std::accumulate(pixels.begin(), pixels.end(), 0.0) / static_cast<double>(pixels.size());
}

TEST_F(AravisLoopback, IsListed) {
  StartCamera();
  const std::vector<CameraInfo> cameras = ListAravisCameras();
  ASSERT_EQ(cameras.size(), 1);
  EXPECT_EQ(cameras[0].uri, process_->uri());
  EXPECT_EQ(cameras[0].vendor, "Aravis");
  EXPECT_EQ(cameras[0].serial, "T1");
}

TEST_F(AravisLoopback, ACameraThatIsNotThereIsNotFound) {
  StartCamera();
  const auto rig =
      OpenAravisRig({.name = "test", .camera_uri = "aravis:Basler-12345678"}, SystemClock());
  EXPECT_TRUE(absl::IsNotFound(rig.status())) << rig.status();
  EXPECT_THAT(std::string(rig.status().message()), HasSubstr("aravis:Basler-12345678"));
}

TEST_F(AravisLoopback, EveryTriggerGivesOneWholeFrameFromTheFirstOn) {
  StartCamera();
  const auto camera = Open();
  ASSERT_TRUE(camera->Configure({.exposure_s = 0.01}).ok());
  ASSERT_TRUE(camera->Start().ok());
  uint64_t previous_id = 0;
  for (int i = 0; i < 10; ++i) {
    const auto frame = TakeFrame(*camera);
    ASSERT_TRUE(frame.ok()) << frame.status();
    EXPECT_EQ(frame->metadata.status, BufferStatus::kComplete) << "frame " << i;
    EXPECT_TRUE(IsRamp(*frame));
    EXPECT_TRUE(i == 0 || frame->metadata.camera_frame_id == previous_id + 1);
    EXPECT_GT(frame->metadata.monotonic_time_ns, *frame->metadata.trigger_time_ns);
    previous_id = frame->metadata.camera_frame_id;
  }
}

TEST_F(AravisLoopback, LargeFramesInSmallAndLargePacketsAreWholeFromTheFirstOn) {
  StartCamera();
  for (const char* packet_size : {"1400", "9000", "60000"}) {
    const auto camera = Open(std::string("?packet_size=") + packet_size);
    EXPECT_EQ(camera->Info().sensor_size, (ImageSize{2048, 2048}));
    ASSERT_TRUE(camera->Configure({.exposure_s = 0.02}).ok());
    ASSERT_TRUE(camera->Start().ok());
    const auto frame = TakeFrame(*camera);
    ASSERT_TRUE(frame.ok()) << frame.status();
    EXPECT_EQ(frame->metadata.status, BufferStatus::kComplete)
        << packet_size << " bytes: " << frame->metadata.missing_packets << " packets missing";
  }
}

TEST_F(AravisLoopback, TheImageFollowsTheExposure) {
  StartCamera();
  const auto camera = Open();
  double darker = 0;
  for (const double exposure_s : {0.002, 0.01, 0.03}) {
    ASSERT_TRUE(camera->Stop().ok());
    const auto set = camera->Configure({.exposure_s = exposure_s});
    ASSERT_TRUE(set.ok()) << set.status();
    EXPECT_EQ(set->exposure_s, exposure_s);
    ASSERT_TRUE(camera->Start().ok());
    const auto frame = TakeFrame(*camera);
    ASSERT_TRUE(frame.ok()) << frame.status();
    EXPECT_GT(Mean(*frame), darker * 1.2);
    darker = Mean(*frame);
  }
}

// Another program leaves the camera free-running on a line trigger, with gain, binning and offsets.
TEST_F(AravisLoopback, WhatAnotherClientLeftBehindIsCleared) {
  StartCamera();
  const std::string id = process_->uri().substr(std::string("aravis:").size());
  const auto set = [](ArvCamera* camera) {
    arv_camera_set_string(camera, "GainAuto", "Continuous", nullptr);
    arv_camera_set_integer(camera, "GainRaw", 7, nullptr);
    arv_camera_set_integer(camera, "OffsetX", 40, nullptr);
    arv_camera_set_integer(camera, "BinningHorizontal", 2, nullptr);
    arv_camera_set_string(camera, "AcquisitionMode", "SingleFrame", nullptr);
    arv_camera_set_string(camera, "TriggerSelector", "AcquisitionStart", nullptr);
    arv_camera_set_string(camera, "TriggerMode", "On", nullptr);
    arv_camera_set_string(camera, "TriggerSelector", "FrameStart", nullptr);
    arv_camera_set_string(camera, "TriggerSource", "Line0", nullptr);
    arv_camera_start_acquisition(camera, nullptr);
  };
  ArvCamera* other = arv_camera_new(id.c_str(), nullptr);
  ASSERT_NE(other, nullptr);
  set(other);
  EXPECT_STREQ(arv_camera_get_string(other, "GainAuto", nullptr), "Continuous");
  g_object_unref(other);

  {
    const auto camera = Open();
    ASSERT_TRUE(camera->Configure({.exposure_s = 0.01}).ok());
    ASSERT_TRUE(camera->Start().ok());
    const auto frame = TakeFrame(*camera);
    ASSERT_TRUE(frame.ok()) << frame.status();
    EXPECT_TRUE(IsRamp(*frame)) << "a gain would show";
  }

  other = arv_camera_new(id.c_str(), nullptr);
  ASSERT_NE(other, nullptr);
  EXPECT_STREQ(arv_camera_get_string(other, "GainAuto", nullptr), "Off");
  EXPECT_EQ(arv_camera_get_integer(other, "GainRaw", nullptr), 0);
  EXPECT_EQ(arv_camera_get_integer(other, "OffsetX", nullptr), 0);
  EXPECT_EQ(arv_camera_get_integer(other, "BinningHorizontal", nullptr), 1);
  EXPECT_STREQ(arv_camera_get_string(other, "AcquisitionMode", nullptr), "Continuous");
  EXPECT_STREQ(arv_camera_get_string(other, "TriggerSource", nullptr), "Software");
  arv_camera_set_string(other, "TriggerSelector", "AcquisitionStart", nullptr);
  EXPECT_STREQ(arv_camera_get_string(other, "TriggerMode", nullptr), "Off");
  g_object_unref(other);
}

// A frame is 189 packets, so that of 10 frames 2, 8 and all lose one or more.
TEST_F(AravisLoopback, AFrameThatLostPacketsIsNeverDataHoweverManyAreLost) {
  const struct {
    int lost_packets_per_thousand;
    int frames;
  } losses[] = {{1, 80}, {10, 30}, {100, 10}};
  int whole = 0;
  for (const auto& loss : losses) {
    StartCamera(loss.lost_packets_per_thousand);
    auto camera = Open();
    ASSERT_TRUE(camera->Configure({.exposure_s = 0.01}).ok());
    ASSERT_TRUE(camera->Start().ok());
    int spoilt = 0;
    for (int i = 0; i < loss.frames; ++i) {
      const auto frame = TakeFrame(*camera);
      if (absl::IsDeadlineExceeded(frame.status())) {  // nothing of it came that tells its end
        ++spoilt;
        continue;
      }
      ASSERT_TRUE(frame.ok()) << frame.status();
      if (frame->metadata.status == BufferStatus::kComplete) {
        EXPECT_TRUE(IsRamp(*frame));
        EXPECT_EQ(frame->metadata.missing_packets, 0);
        ++whole;
        continue;
      }
      EXPECT_TRUE(frame->view.pixels_dn.empty());
      ++spoilt;
    }
    EXPECT_GT(spoilt, 0) << loss.lost_packets_per_thousand << " packets of 1000 lost";
    camera.reset();  // before its process ends: closing a camera that is gone takes Aravis 10 s
    process_.reset();
  }
  EXPECT_GT(whole, 0);
}

TEST_F(AravisLoopback, ARunOverALossyNetworkRecordsWholeFramesOnly) {
  StartCamera(2);  // 3 frames of 10 lose a packet
  auto rig = OpenRig(kMono8);
  ASSERT_TRUE(rig.ok()) << rig.status();
  const auto plan = MakeGreyPlan(
      {.levels = 2, .exposures_s = {0.01}, .repeats = 2, .dark_repeats = 2, .flat_repeats = 0});
  ASSERT_TRUE(plan.ok()) << plan.status();
  MemoryRecording recording;
  const auto report = RunPlan(*rig, *plan, recording, {.attempts = 50});
  ASSERT_TRUE(report.ok()) << report.status();
  EXPECT_EQ(recording.Published().size(), 3);
  for (const auto& capture : recording.Published()) {
    ASSERT_EQ(capture->frames.size(), 2);
    for (const Frame& frame : capture->frames) EXPECT_TRUE(IsRamp(frame));
    EXPECT_EQ(capture->frames[1].metadata.camera_frame_id,
              capture->frames[0].metadata.camera_frame_id + 1);
  }
}

TEST_F(AravisLoopback, AKilledCameraIsLostAndItsSuccessorIsOpenedAnew) {
  StartCamera();
  auto camera = Open();
  ASSERT_TRUE(camera->Configure({.exposure_s = 0.03}).ok());
  ASSERT_TRUE(camera->Start().ok());
  const auto before = TakeFrame(*camera);
  ASSERT_TRUE(before.ok()) << before.status();
  process_->Kill();
  const auto lost = TakeFrame(*camera);
  EXPECT_TRUE(absl::IsUnavailable(lost.status())) << lost.status();
  EXPECT_THAT(std::string(lost.status().message()), HasSubstr("is gone"));
  // It stays lost even where another camera answers at its address.
  StartCamera();
  EXPECT_TRUE(absl::IsUnavailable(camera->Trigger()));
  EXPECT_TRUE(camera->Stop().ok());
  EXPECT_TRUE(absl::IsUnavailable(camera->Configure({.exposure_s = 0.03}).status()));
  camera = Open();
  ASSERT_NE(camera, nullptr);
  const auto set = camera->Configure({.exposure_s = 0.03});
  ASSERT_TRUE(set.ok()) << set.status();
  EXPECT_EQ(set->exposure_s, 0.03);
  ASSERT_TRUE(camera->Start().ok());
  const auto after = TakeFrame(*camera);
  ASSERT_TRUE(after.ok()) << after.status();
  EXPECT_GT(Mean(*after), 100) << "the exposure was not pushed again";
  EXPECT_GT(Mean(*before), 100);
}

TEST_F(AravisLoopback, ASilentCameraIsToldFromALostOne) {
  StartCamera();
  const auto camera = Open();
  ASSERT_TRUE(camera->Configure({.trigger = TriggerSource::kLine, .trigger_line = "Line0"}).ok());
  ASSERT_TRUE(camera->Start().ok());
  EXPECT_TRUE(absl::IsDeadlineExceeded(camera->NextFrame(milliseconds(50)).status()));
  process_->Kill();
  EXPECT_TRUE(absl::IsUnavailable(camera->NextFrame(milliseconds(50)).status()));
}

}  // namespace
}  // namespace eyebox::capture
