// The Aravis camera on Aravis' own fake device, within this process.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "capture/camera/aravis/aravis_rig.h"
#include "capture/camera/aravis/fake_scene.h"

namespace eyebox::capture {
namespace {

using std::chrono::milliseconds;
using testing::HasSubstr;

constexpr milliseconds kTimeout{10000};  // never waited for where all is well
constexpr const char* kSmall = "aravis:fake?region=65x33+0+0";

std::unique_ptr<Camera> Open(const std::string& uri) {
  auto rig = OpenAravisRig({.name = "test", .camera_uri = uri}, SystemClock());
  EXPECT_TRUE(rig.ok()) << rig.status();
  return rig.ok() ? std::move(rig->camera) : nullptr;
}

Frame TakeFrame(Camera& camera) {
  EXPECT_TRUE(camera.Trigger().ok());
  auto frame = camera.NextFrame(kTimeout);
  EXPECT_TRUE(frame.ok()) << frame.status();
  return frame.ok() ? *std::move(frame) : Frame{};
}

Frame TakeFrame(Camera& camera, const CameraSettings& settings) {
  EXPECT_TRUE(camera.Stop().ok());
  const auto set = camera.Configure(settings);
  EXPECT_TRUE(set.ok()) << set.status();
  EXPECT_TRUE(camera.Start().ok());
  return TakeFrame(camera);
}

// The ramp moves with the device's id, of which the unwrapped one tells no more than its start.
void ExpectRamp(const Frame& frame, double exposure_s, double full_scale_dn) {
  ASSERT_EQ(frame.metadata.status, BufferStatus::kComplete);
  const auto [width, height] = frame.view.size;
  ASSERT_EQ(frame.view.pixels_dn.size(), frame.view.size.PixelCount());
  const uint64_t id = (frame.metadata.camera_frame_id - 1) % 65535 + 1;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const int position = static_cast<int>((x + y + id) % aravis::kFakeRampPixels);
      ASSERT_EQ(frame.view.pixels_dn[static_cast<size_t>(y) * width + x],
                aravis::FakeRampCount(position, exposure_s, full_scale_dn))
          << "at " << x << ", " << y;
    }
  }
}

TEST(AravisFake, DescribesItself) {
  const auto camera = Open("aravis:fake");
  const CameraInfo& info = camera->Info();
  EXPECT_EQ(info.uri, "aravis:fake");
  EXPECT_EQ(info.vendor, "Aravis");
  EXPECT_EQ(info.model, "Fake");
  EXPECT_EQ(info.serial, "fake");
  EXPECT_EQ(info.sensor_size, (ImageSize{2048, 2048}));
  EXPECT_EQ(info.pixel_format, "Mono16");
  EXPECT_EQ(info.significant_bits, 16);
  EXPECT_DOUBLE_EQ(info.exposure_min_s, 1e-5);
  EXPECT_DOUBLE_EQ(info.exposure_max_s, 10);
  EXPECT_EQ(info.gain_max_db, 0) << "its raw gain has no known unit";
  EXPECT_TRUE(info.software_trigger);
  EXPECT_THAT(info.trigger_lines, testing::ElementsAre("Line0"));
}

TEST(AravisFake, ReadsBackWhatWasSet) {
  const auto camera = Open(kSmall);
  for (const double exposure_s : {1e-5, 0.00125, 0.02, 10.0}) {
    const auto set = camera->Configure({.exposure_s = exposure_s});
    ASSERT_TRUE(set.ok()) << set.status();
    EXPECT_EQ(*set, (CameraSettings{.exposure_s = exposure_s}));
  }
}

TEST(AravisFake, TheImageFollowsTheExposure) {
  const auto camera = Open(kSmall);
  for (const double exposure_s : {0.001, 0.002, 0.008, 0.1}) {
    const Frame frame = TakeFrame(*camera, {.exposure_s = exposure_s});
    ExpectRamp(frame, exposure_s, 65535);
    EXPECT_EQ(frame.metadata.exposure_asked_s, exposure_s);
    EXPECT_FALSE(frame.metadata.exposure_reported_s.has_value()) << "frames carry no chunk";
  }
}

class OfferedFormat : public testing::TestWithParam<const char*> {};

TEST_P(OfferedFormat, ArrivesAsCountsWithItsMosaic) {
  const std::string name = GetParam();
  const auto camera = Open(std::string(kSmall) + "&pixel_format=" + name);
  EXPECT_EQ(camera->Info().pixel_format, name);
  EXPECT_EQ(camera->Info().significant_bits, name == "Mono16" ? 16 : 8);
  ExpectRamp(TakeFrame(*camera, {.exposure_s = 0.01}), 0.01, name == "Mono16" ? 65535 : 255);
}

INSTANTIATE_TEST_SUITE_P(Formats, OfferedFormat,
                         testing::Values("Mono8", "Mono16", "BayerRG8", "BayerGR8", "BayerGB8",
                                         "BayerBG8"));

TEST(AravisFake, AFormatOrRegionThatItLacksIsRefusedByName) {
  const auto open = [](const std::string& uri) {
    return OpenAravisRig({.name = "test", .camera_uri = uri}, SystemClock()).status();
  };
  const absl::Status format = open("aravis:fake?pixel_format=Mono12p");
  EXPECT_TRUE(absl::IsInvalidArgument(format));
  EXPECT_THAT(std::string(format.message()), HasSubstr("ask for Mono16 Mono8"));
  const absl::Status region = open("aravis:fake?region=1024x1024+1025+0");
  EXPECT_TRUE(absl::IsInvalidArgument(region));
  EXPECT_THAT(std::string(region.message()), HasSubstr("2048x2048+0+0"));
}

TEST(AravisFake, EveryTriggerGivesOneFrameAcrossTheWrapOfIds) {
  const auto camera = Open("aravis:fake?region=16x16+0+0&fake_rate_hz=5000");
  Frame previous = TakeFrame(*camera, {.exposure_s = 0.001});
  const uint64_t first_id = previous.metadata.camera_frame_id;
  ASSERT_LT(first_id, 65535) << "or nothing wraps here";
  for (int i = 0; i < 300; ++i) {
    const Frame frame = TakeFrame(*camera);
    ASSERT_EQ(frame.metadata.camera_frame_id, previous.metadata.camera_frame_id + 1);
    ASSERT_GE(*frame.metadata.trigger_time_ns, previous.metadata.monotonic_time_ns);
    ASSERT_GE(frame.metadata.monotonic_time_ns, *frame.metadata.trigger_time_ns);
    ExpectRamp(frame, 0.001, 65535);
    previous = frame;
  }
  EXPECT_GT(first_id + 300, 65535);
}

TEST(AravisFake, TriggersAheadOfTheFramesAreKept) {
  const auto camera = Open(kSmall);
  const Frame first = TakeFrame(*camera, {.exposure_s = 0.001});
  for (int i = 0; i < 5; ++i) ASSERT_TRUE(camera->Trigger().ok());
  std::vector<int64_t> trigger_times_ns;
  for (uint64_t i = 1; i <= 5; ++i) {
    const auto frame = camera->NextFrame(kTimeout);
    ASSERT_TRUE(frame.ok()) << frame.status();
    EXPECT_EQ(frame->metadata.camera_frame_id, first.metadata.camera_frame_id + i);
    trigger_times_ns.push_back(*frame->metadata.trigger_time_ns);
  }
  EXPECT_TRUE(std::ranges::is_sorted(trigger_times_ns));
  EXPECT_TRUE(absl::IsDeadlineExceeded(camera->NextFrame(kTimeout).status()));
}

TEST(AravisFake, FramesOutliveTheCamera) {
  std::vector<Frame> frames;
  for (const char* format : {"Mono16", "Mono8"}) {
    const auto camera = Open(std::string(kSmall) + "&pixel_format=" + format);
    frames.push_back(TakeFrame(*camera, {.exposure_s = 0.01}));
    frames.push_back(TakeFrame(*camera));
  }
  ExpectRamp(frames[0], 0.01, 65535);
  ExpectRamp(frames[1], 0.01, 65535);
  ExpectRamp(frames[2], 0.01, 255);
  ExpectRamp(frames[3], 0.01, 255);
}

TEST(AravisFake, HeldFramesAreNeverOverwrittenAndComeBackWhenLetGo) {
  const auto camera = Open(std::string(kSmall) + "&buffers=3");
  std::vector<Frame> held = {TakeFrame(*camera, {.exposure_s = 0.01})};
  held.push_back(TakeFrame(*camera));
  held.push_back(TakeFrame(*camera));
  const absl::Status refused = camera->Trigger();
  EXPECT_TRUE(absl::IsFailedPrecondition(refused)) << refused;
  EXPECT_THAT(std::string(refused.message()), HasSubstr("buffers"));
  for (const Frame& frame : held) ExpectRamp(frame, 0.01, 65535);
  held.erase(held.begin());
  held.push_back(TakeFrame(*camera));
  for (const Frame& frame : held) ExpectRamp(frame, 0.01, 65535);
}

TEST(AravisFake, RunsFreeUntilItIsStopped) {
  const auto camera = Open(kSmall);
  ASSERT_TRUE(
      camera
          ->Configure(
              {.exposure_s = 0.001, .trigger = TriggerSource::kFreeRun, .frame_rate_hz = 500})
          .ok());
  ASSERT_TRUE(camera->Start().ok());
  uint64_t previous_id = 0;
  for (int i = 0; i < 20; ++i) {
    const auto frame = camera->NextFrame(kTimeout);
    ASSERT_TRUE(frame.ok()) << frame.status();
    ExpectRamp(*frame, 0.001, 65535);
    EXPECT_FALSE(frame->metadata.trigger_time_ns.has_value());
    EXPECT_TRUE(i == 0 || frame->metadata.camera_frame_id == previous_id + 1);
    previous_id = frame->metadata.camera_frame_id;
  }
  EXPECT_TRUE(absl::IsFailedPrecondition(camera->Trigger()));
  ASSERT_TRUE(camera->Stop().ok());
  EXPECT_TRUE(absl::IsFailedPrecondition(camera->NextFrame(kTimeout).status()));
}

TEST(AravisFake, AFrameRateBeyondItsLimitsIsRefusedByName) {
  const auto camera = Open(kSmall);
  const auto set = camera->Configure(
      {.exposure_s = 0.001, .trigger = TriggerSource::kFreeRun, .frame_rate_hz = 5000});
  EXPECT_TRUE(absl::IsInvalidArgument(set.status())) << set.status();
  EXPECT_THAT(std::string(set.status().message()), HasSubstr("frame_rate_hz"));
}

TEST(AravisFake, OnALineTriggerSoftwareTriggersAreRefused) {
  const auto camera = Open(kSmall);
  const auto unknown =
      camera->Configure({.trigger = TriggerSource::kLine, .trigger_line = "Line7"});
  EXPECT_TRUE(absl::IsInvalidArgument(unknown.status()));
  EXPECT_THAT(std::string(unknown.status().message()), HasSubstr("Line0"));
  ASSERT_TRUE(camera->Configure({.trigger = TriggerSource::kLine, .trigger_line = "Line0"}).ok());
  ASSERT_TRUE(camera->Start().ok());
  EXPECT_TRUE(absl::IsFailedPrecondition(camera->Trigger()));
}

TEST(AravisFake, SeveralCamerasRunSideBySide) {
  const auto a = Open(kSmall);
  const auto b = Open("aravis:fake?region=31x7+0+0&pixel_format=Mono8");
  ASSERT_TRUE(a->Configure({.exposure_s = 0.001}).ok());
  ASSERT_TRUE(b->Configure({.exposure_s = 0.005}).ok());
  ASSERT_TRUE(a->Start().ok());
  ASSERT_TRUE(b->Start().ok());
  for (int i = 0; i < 10; ++i) {
    ASSERT_TRUE(a->Trigger().ok());
    ExpectRamp(TakeFrame(*b), 0.005, 255);
    const auto frame = a->NextFrame(kTimeout);
    ASSERT_TRUE(frame.ok()) << frame.status();
    ExpectRamp(*frame, 0.001, 65535);
  }
}

}  // namespace
}  // namespace eyebox::capture
