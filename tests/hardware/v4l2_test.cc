// The V4L2 camera on the kernel's vivid driver.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/videodev2.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>
#include <tuple>

#include "capture/base/clock.h"
#include "capture/camera/rig.h"
#include "capture/camera/v4l2/v4l2_camera.h"
#include "capture/plan.h"
#include "capture/recording/reader.h"
#include "capture/recording/writer.h"
#include "capture/run.h"
#include "tests/hardware/vivid.h"

namespace eyebox::capture {
namespace {

using std::chrono::milliseconds;
using testing::HasSubstr;

constexpr CameraSettings kSettings = {.exposure_s = 0.02, .gain_db = 0};
constexpr milliseconds kTimeout{10000};  // the guest is emulated and may be slow

CaptureSpec DarkOf(int repeats) {
  CaptureSpec spec;
  spec.kind = FrameKind::kDark;
  spec.exposure_s = kSettings.exposure_s;
  spec.repeats = repeats;
  return spec;
}

class Vivid : public testing::Test {
 protected:
  void SetUp() override {
    nodes_ = VividNodes();
    if (nodes_.empty()) GTEST_SKIP() << "no vivid camera here; run tests/hardware/run";
    ASSERT_EQ(nodes_.size(), 2) << "one with a single plane, one multi-planar";
    for (const std::string& node : nodes_) {
      SetVivid(node, VividControl::kTestPattern, static_cast<int32_t>(VividPattern::kRed));
      SetVivid(node, VividControl::kOsdTextMode, 2);
      SetVivid(node, VividControl::kTimestampSource, 0);
      SetVivid(node, VividControl::kDroppedPercent, 0);
    }
  }

  Rig OpenRigOf(const std::string& node, const std::string& format) {
    const RigConfig config = {.name = "vivid",
                              .camera_uri = "v4l2:" + node + "?size=320x180&format=" + format};
    auto rig = OpenRig(config, SystemClock());
    EXPECT_TRUE(rig.ok()) << rig.status();
    return *std::move(rig);
  }

  void Start(const std::string& format = "Y10") {
    rig_ = OpenRigOf(nodes_[0], format);
    const auto set = camera().Configure(kSettings);
    ASSERT_TRUE(set.ok()) << set.status();
    EXPECT_EQ(set->exposure_s, kSettings.exposure_s);
    ASSERT_TRUE(camera().Start().ok());
  }

  Camera& camera() { return *rig_.camera; }

  absl::StatusOr<Frame> Take() {
    if (absl::Status status = camera().Trigger(); !status.ok()) return status;
    return camera().NextFrame(kTimeout);
  }

  std::vector<std::string> nodes_;
  Rig rig_;
};

struct Expected {
  const char* format;
  int bits;
  const char* pixel_format;
  int red_x;  // column and row of a red pixel within the upper left 2 x 2; -1: monochrome
  int red_y;
};

class VividFormat : public Vivid, public testing::WithParamInterface<std::tuple<Expected, int>> {
 protected:
  void CheckPixels(const Frame& frame, const Expected& expected) {
    const int width = frame.view.size.width_px;
    const auto at = [&](int x, int y) { return frame.view.pixels_dn[y * width + x]; };
    const double full_dn = (1 << expected.bits) - 1;
    if (expected.red_x < 0) {
      // One grey all over: luma of pure red, neither black nor white.
      EXPECT_EQ(std::ranges::count(frame.view.pixels_dn, at(0, 0)), frame.view.pixels_dn.size());
      EXPECT_GT(at(0, 0), 0.1 * full_dn);
      EXPECT_LT(at(0, 0), 0.5 * full_dn);
      return;
    }
    for (int y = 0; y < frame.view.size.height_px; ++y) {
      for (int x = 0; x < width; ++x) {
        if (x % 2 == expected.red_x && y % 2 == expected.red_y) {
          ASSERT_GT(at(x, y), 0.9 * full_dn) << x << ", " << y;
        } else {
          ASSERT_LT(at(x, y), 0.1 * full_dn) << x << ", " << y;
        }
      }
    }
  }
};

TEST_P(VividFormat, StreamsIntoARecordingThatVerifies) {
  const auto& [expected, node] = GetParam();
  Rig rig = OpenRigOf(nodes_[static_cast<size_t>(node)], expected.format);
  EXPECT_EQ(rig.camera->Info().significant_bits, expected.bits);
  EXPECT_EQ(rig.camera->Info().pixel_format, expected.pixel_format);

  CapturePlan plan;
  plan.captures.assign(2, DarkOf(4));
  const std::filesystem::path folder =
      std::filesystem::path(testing::TempDir()) /
      (std::string("vivid_") + expected.format + "_" + std::to_string(node));
  std::filesystem::remove_all(folder);
  auto writer =
      RecordingWriter::Create(folder, MakeHeader(rig, plan, *SystemClock()), SystemClock());
  ASSERT_TRUE(writer.ok()) << writer.status();
  const auto report = RunPlan(rig, plan, **writer, {.frame_timeout = kTimeout});
  ASSERT_TRUE(report.ok()) << report.status();
  EXPECT_EQ(report->frames, 8);

  const auto verified = VerifyRecording(folder);
  ASSERT_TRUE(verified.ok()) << verified.status();
  EXPECT_EQ(verified->frames, 8);
  auto reader = RecordingReader::Open(folder);
  ASSERT_TRUE(reader.ok()) << reader.status();
  for (const CaptureEntry& capture : (*reader)->Captures()) {
    const absl::Status visited = (*reader)->VisitFrames(capture, [&](const Frame& frame) {
      CheckPixels(frame, expected);
      return absl::OkStatus();
    });
    EXPECT_TRUE(visited.ok()) << visited;
  }
}

INSTANTIATE_TEST_SUITE_P(Formats, VividFormat,
                         testing::Combine(testing::Values(Expected{"GREY", 8, "Mono8", -1, -1},
                                                          Expected{"Y10", 10, "Mono10", -1, -1},
                                                          Expected{"Y12", 12, "Mono12", -1, -1},
                                                          Expected{"Y16", 16, "Mono16", -1, -1},
                                                          Expected{"RGGB", 8, "BayerRG8", 0, 0},
                                                          Expected{"BA81", 8, "BayerBG8", 1, 1},
                                                          Expected{"BA10", 10, "BayerGR10", 1, 0},
                                                          Expected{"GB12", 12, "BayerGB12", 0, 1},
                                                          Expected{"BYR2", 16, "BayerBG16", 1, 1}),
                                          testing::Values(0, 1)),
                         [](const auto& test) {
                           return std::string(std::get<0>(test.param).format) +
                                  (std::get<1>(test.param) == 0 ? "SinglePlanar" : "MultiPlanar");
                         });

TEST_F(Vivid, HasEverythingAutomaticOffOnceConfigured) {
  Start();
  EXPECT_EQ(ReadControlOf(nodes_[0], V4L2_CID_EXPOSURE_AUTO), V4L2_EXPOSURE_MANUAL);
  EXPECT_EQ(ReadControlOf(nodes_[0], V4L2_CID_EXPOSURE_AUTO_PRIORITY), 0);
  EXPECT_EQ(ReadControlOf(nodes_[0], V4L2_CID_AUTOGAIN), 0);
  EXPECT_EQ(ReadControlOf(nodes_[0], V4L2_CID_AUTO_WHITE_BALANCE), 0);
  EXPECT_EQ(ReadControlOf(nodes_[0], V4L2_CID_BACKLIGHT_COMPENSATION), 0);
  EXPECT_EQ(ReadControlOf(nodes_[0], V4L2_CID_POWER_LINE_FREQUENCY),
            V4L2_CID_POWER_LINE_FREQUENCY_DISABLED);
  EXPECT_EQ(ReadControlOf(nodes_[0], V4L2_CID_EXPOSURE_ABSOLUTE), 200);
}

TEST_F(Vivid, StampsFramesOnTheClockOfTheTriggers) {
  Start();
  const auto frame = Take();
  ASSERT_TRUE(frame.ok()) << frame.status();
  ASSERT_TRUE(frame->metadata.device_time_ns && frame->metadata.trigger_time_ns);
  EXPECT_GT(*frame->metadata.device_time_ns, *frame->metadata.trigger_time_ns);
}

TEST_F(Vivid, TakesStampsOfTheStartOfAFrameToo) {
  SetVivid(nodes_[0], VividControl::kTimestampSource, 1);
  Start();
  const auto frame = Take();
  ASSERT_TRUE(frame.ok()) << frame.status();
  EXPECT_GE(*frame->metadata.device_time_ns, *frame->metadata.trigger_time_ns);
  // (As the end of a frame vivid states a moment to come, one interval after the start.)
  EXPECT_LE(*frame->metadata.device_time_ns, frame->metadata.monotonic_time_ns);
}

TEST_F(Vivid, ShowsDroppedBuffersAsGaps) {
  Start();
  SetVivid(nodes_[0], VividControl::kDroppedPercent, 70);
  uint64_t last_id = 0;
  for (int i = 0; i < 12; ++i) {
    const auto frame = Take();
    ASSERT_TRUE(frame.ok()) << frame.status();
    last_id = frame->metadata.camera_frame_id;
  }
  EXPECT_GT(last_id, 12);
}

TEST_F(Vivid, FailsARunWhoseFramesAreDropped) {
  rig_ = OpenRigOf(nodes_[0], "Y10");
  SetVivid(nodes_[0], VividControl::kDroppedPercent, 70);
  CapturePlan plan;
  plan.captures = {DarkOf(12)};
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "vivid_dropped";
  std::filesystem::remove_all(folder);
  auto writer =
      RecordingWriter::Create(folder, MakeHeader(rig_, plan, *SystemClock()), SystemClock());
  ASSERT_TRUE(writer.ok()) << writer.status();
  const auto report = RunPlan(rig_, plan, **writer, {.attempts = 2, .frame_timeout = kTimeout});
  ASSERT_TRUE(absl::IsUnavailable(report.status())) << report.status();
  EXPECT_THAT(std::string(report.status().message()), HasSubstr("dropped"));
}

TEST_F(Vivid, MarksSpoiltBuffers) {
  Start();
  ASSERT_TRUE(Take().ok());
  // The button spoils one buffer, perhaps one that nobody asked for: press it until it hits.
  const std::jthread presser([this](const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      SetVivid(nodes_[0], VividControl::kSpoilNextBuffer, 1);
      std::this_thread::sleep_for(milliseconds(2));
    }
  });
  BufferStatus status = BufferStatus::kComplete;
  for (int i = 0; i < 20 && status == BufferStatus::kComplete; ++i) {
    const auto frame = Take();
    ASSERT_TRUE(frame.ok()) << frame.status();
    status = frame->metadata.status;
    EXPECT_EQ(frame->view.pixels_dn.empty(), status != BufferStatus::kComplete);
  }
  EXPECT_EQ(status, BufferStatus::kDeviceError);
}

TEST_F(Vivid, IsUnavailableOnceDisconnectedAndUsableOnceOpenedAnew) {
  Start();
  ASSERT_TRUE(Take().ok());
  SetVivid(nodes_[0], VividControl::kDisconnect, 1);
  const absl::Status lost = Take().status();
  ASSERT_TRUE(absl::IsUnavailable(lost)) << lost;
  EXPECT_THAT(std::string(lost.message()), HasSubstr("unplugged"));
  EXPECT_TRUE(camera().Stop().ok());
  rig_.camera.reset();
  Start();
  const auto frame = Take();
  EXPECT_TRUE(frame.ok()) << frame.status();
}

TEST_F(Vivid, IsUnavailableAfterAFatalStreamingError) {
  Start();
  ASSERT_TRUE(Take().ok());
  SetVivid(nodes_[0], VividControl::kFatalStreamingError, 1);
  const absl::Status status = Take().status();
  EXPECT_TRUE(absl::IsUnavailable(status)) << status;
}

TEST_F(Vivid, TellsWhenAnotherProgramTurnsAutomaticExposureOn) {
  Start();
  ASSERT_TRUE(Take().ok());
  SetVivid(nodes_[0], static_cast<VividControl>(V4L2_CID_EXPOSURE_AUTO),
           V4L2_EXPOSURE_APERTURE_PRIORITY);
  const absl::Status status = Take().status();
  ASSERT_TRUE(absl::IsUnavailable(status)) << status;
  EXPECT_THAT(std::string(status.message()), HasSubstr("Auto Exposure"));
}

TEST_F(Vivid, IsListedWithItsRawFormats) {
  for (const V4l2Listing& listing : ListV4l2Cameras()) {
    if (listing.driver != "vivid") continue;
    EXPECT_EQ(listing.problem, "");
    EXPECT_THAT(listing.formats, testing::IsSupersetOf({"GREY", "Y10", "Y12", "Y16", "RG12"}));
  }
}

}  // namespace
}  // namespace eyebox::capture
