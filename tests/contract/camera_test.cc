// What every camera must do, run on each that opens without hardware.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "capture/camera/rig.h"
#include "capture/recording/writer.h"
#include "capture/run.h"
#include "tests/capture/camera/aravis_fake_process.h"
#include "tests/support/temporary_folder.h"

namespace eyebox::capture {
namespace {

constexpr std::chrono::milliseconds kTimeout(1000);
constexpr int kRepeats = 4;

CaptureSpec Grey(double drive, double exposure_s) {
  CaptureSpec spec;
  spec.stimulus.drive = DriveRgb{drive, drive, drive};
  spec.exposure_s = exposure_s;
  spec.repeats = kRepeats;
  return spec;
}

const CaptureSpec kBright = Grey(0.6, 0.0125);
const CaptureSpec kLong = Grey(0.6, 0.025);

// How to come by a rig whose presenter knows kBright and kLong.
struct CameraCase {
  const char* name;
  std::string (*uri)(const std::filesystem::path& folder);
  bool linear = true;           // counts are proportional to the exposure
  bool queues_triggers = true;  // those that come before the frame of the one before
};

std::string SimUri(const std::filesystem::path&) { return "sim:rift-s-like"; }

std::string ReplayUri(const std::filesystem::path& folder) {
  auto rig = OpenRig({.name = "source", .camera_uri = "sim:rift-s-like"}, SystemClock());
  EXPECT_TRUE(rig.ok()) << rig.status();
  const CapturePlan plan = {{kBright, kLong}};
  auto writer = RecordingWriter::Create(folder / "recording",
                                        MakeHeader(*rig, plan, *SystemClock()), SystemClock());
  EXPECT_TRUE(writer.ok()) << writer.status();
  const auto report = RunPlan(*rig, plan, **writer);
  EXPECT_TRUE(report.ok()) << report.status();
  return "replay:" + (folder / "recording").string();
}

// A whole period of its ramp, so that the mean does not move with it.
std::string AravisFakeUri(const std::filesystem::path&) { return "aravis:fake?region=1024x8+0+0"; }

// A process of its own for every test, which ends with the next one or with the program.
std::string AravisGigEUri(const std::filesystem::path&) {
  static std::unique_ptr<FakeGigECamera> process;
  std::string why_not;
  EXPECT_TRUE(EnterPrivateNetwork(why_not)) << why_not;
  process.reset();
  process = FakeGigECamera::Start("C1");
  EXPECT_NE(process, nullptr) << "is aravis-tools installed?";
  return process ? process->uri() + "?region=512x512+0+0" : "";
}

class CameraContract : public testing::TestWithParam<CameraCase> {
 protected:
  void SetUp() override {
    uri_ = GetParam().uri(folder_.path());
    auto rig = OpenRig({.name = "contract", .camera_uri = uri_}, SystemClock());
    ASSERT_TRUE(rig.ok()) << rig.status();
    rig_ = *std::move(rig);
  }

  Camera& camera() { return *rig_.camera; }

  void Begin(const CaptureSpec& spec) {
    ASSERT_TRUE(camera().Stop().ok());
    ASSERT_TRUE(rig_.presenter->Present(spec).ok());
    ASSERT_TRUE(camera().Configure({spec.exposure_s, spec.gain_db}).ok());
    ASSERT_TRUE(camera().Start().ok());
  }

  Frame Take() {
    EXPECT_TRUE(camera().Trigger().ok());
    auto frame = camera().NextFrame(kTimeout);
    EXPECT_TRUE(frame.ok()) << frame.status();
    return frame.ok() ? *std::move(frame) : Frame();
  }

  const TemporaryFolder folder_;
  std::string uri_;
  Rig rig_;
};

INSTANTIATE_TEST_SUITE_P(Cameras, CameraContract,
                         testing::Values(CameraCase{"sim", SimUri}, CameraCase{"replay", ReplayUri},
                                         CameraCase{"aravis_fake", AravisFakeUri},
                                         CameraCase{"aravis_gige", AravisGigEUri, false, false}),
                         [](const auto& test) { return test.param.name; });

TEST_P(CameraContract, DescribesItself) {
  const CameraInfo& info = camera().Info();
  EXPECT_EQ(info.uri, uri_);
  EXPECT_GT(info.sensor_size.PixelCount(), 0U);
  EXPECT_GE(info.significant_bits, 1);
  EXPECT_LE(info.significant_bits, 16);
  EXPECT_GT(info.exposure_min_s, 0);
  EXPECT_LE(info.exposure_min_s, info.exposure_max_s);
  EXPECT_LE(info.gain_min_db, info.gain_max_db);
}

TEST_P(CameraContract, ReadsBackWhatItWasSetTo) {
  const auto set = camera().Configure({kBright.exposure_s, 0});
  ASSERT_TRUE(set.ok()) << set.status();
  EXPECT_NEAR(set->exposure_s, kBright.exposure_s, 1e-4 * kBright.exposure_s);
  EXPECT_EQ(set->gain_db, 0);
}

TEST_P(CameraContract, RefusesSettingsBeyondItsLimitsByName) {
  const CameraInfo info = camera().Info();
  const struct {
    CameraSettings settings;
    const char* field;
  } cases[] = {{{2 * info.exposure_max_s, 0}, "exposure_s"},
               {{info.exposure_min_s / 2, 0}, "exposure_s"},
               {{-1, 0}, "exposure_s"},
               {{std::nan(""), 0}, "exposure_s"},
               {{kBright.exposure_s, info.gain_max_db + 1}, "gain_db"},
               {{kBright.exposure_s, info.gain_min_db - 1}, "gain_db"}};
  for (const auto& [settings, field] : cases) {
    const absl::Status status = camera().Configure(settings).status();
    EXPECT_TRUE(absl::IsInvalidArgument(status)) << status;
    EXPECT_THAT(std::string(status.message()), testing::HasSubstr(field));
  }
}

TEST_P(CameraContract, StartsOnlyConfiguredAndOnlyOnce) {
  EXPECT_TRUE(absl::IsFailedPrecondition(camera().Start())) << "never configured";
  ASSERT_TRUE(camera().Configure({kBright.exposure_s, 0}).ok());
  EXPECT_TRUE(camera().Start().ok());
  EXPECT_TRUE(absl::IsFailedPrecondition(camera().Start())) << "runs already";
  EXPECT_TRUE(absl::IsFailedPrecondition(camera().Configure({kBright.exposure_s, 0}).status()))
      << "runs";
}

TEST_P(CameraContract, GivesNothingWhileStopped) {
  ASSERT_TRUE(rig_.presenter->Present(kBright).ok());
  ASSERT_TRUE(camera().Configure({kBright.exposure_s, 0}).ok());
  EXPECT_TRUE(absl::IsFailedPrecondition(camera().Trigger()));
  EXPECT_TRUE(absl::IsFailedPrecondition(camera().NextFrame(kTimeout).status()));
}

TEST_P(CameraContract, WithoutATriggerNoFrameComes) {
  Begin(kBright);
  EXPECT_TRUE(absl::IsDeadlineExceeded(camera().NextFrame(std::chrono::milliseconds(1)).status()));
  Take();
  EXPECT_TRUE(absl::IsDeadlineExceeded(camera().NextFrame(std::chrono::milliseconds(1)).status()));
}

TEST_P(CameraContract, NumbersItsFramesWithoutGap) {
  Begin(kBright);
  std::optional<uint64_t> previous;
  for (int i = 0; i < kRepeats; ++i) {
    const Frame frame = Take();
    if (previous) {
      EXPECT_EQ(frame.metadata.camera_frame_id, *previous + 1);
    }
    previous = frame.metadata.camera_frame_id;
  }
}

TEST_P(CameraContract, QueuesWhatWasTriggered) {
  if (!GetParam().queues_triggers) GTEST_SKIP() << "it has one trigger register and no queue";
  Begin(kBright);
  for (int i = 0; i < kRepeats; ++i) ASSERT_TRUE(camera().Trigger().ok());
  std::vector<uint64_t> ids;
  for (int i = 0; i < kRepeats; ++i) {
    const auto frame = camera().NextFrame(kTimeout);
    ASSERT_TRUE(frame.ok()) << frame.status();
    ids.push_back(frame->metadata.camera_frame_id);
  }
  EXPECT_EQ(ids.back(), ids.front() + kRepeats - 1);
}

TEST_P(CameraContract, FramesCarryPixelsAndMetadata) {
  Begin(kBright);
  const Frame frame = Take();
  EXPECT_EQ(frame.metadata.status, BufferStatus::kComplete);
  EXPECT_EQ(frame.metadata.missing_packets, 0U);
  EXPECT_EQ(frame.metadata.exposure_asked_s, kBright.exposure_s);
  EXPECT_EQ(frame.metadata.gain_asked_db, 0);
  EXPECT_GT(frame.metadata.monotonic_time_ns, 0);
  EXPECT_EQ(frame.view.size, camera().Info().sensor_size);
  ASSERT_EQ(frame.view.pixels_dn.size(), camera().Info().sensor_size.PixelCount());
  for (const uint16_t count_dn : frame.view.pixels_dn) {
    ASSERT_LT(count_dn, 1 << camera().Info().significant_bits);
  }
}

TEST_P(CameraContract, TwiceTheExposureIsTwiceTheLight) {
  if (!GetParam().linear) GTEST_SKIP() << "it draws the logarithm of the exposure";
  const auto mean_dn = [this](const CaptureSpec& spec) {
    Begin(spec);
    double sum_dn = 0;
    const Frame frame = Take();
    for (const uint16_t count_dn : frame.view.pixels_dn) sum_dn += count_dn;
    return sum_dn / static_cast<double>(frame.view.pixels_dn.size());
  };
  const double short_dn = mean_dn(kBright);
  const double long_dn = mean_dn(kLong);
  constexpr double kBiasBelow_dn = 200;  // of every camera here
  EXPECT_GT(long_dn, 2 * short_dn - kBiasBelow_dn);
  EXPECT_LT(long_dn, 2 * short_dn + 1);
}

TEST_P(CameraContract, FramesOutliveTheCamera) {
  Begin(kBright);
  const Frame frame = Take();
  const std::vector<uint16_t> before(frame.view.pixels_dn.begin(), frame.view.pixels_dn.end());
  rig_ = Rig();
  EXPECT_TRUE(std::ranges::equal(frame.view.pixels_dn, before));
}

TEST_P(CameraContract, StopDropsWhatIsPending) {
  Begin(kBright);
  ASSERT_TRUE(camera().Trigger().ok());
  ASSERT_TRUE(camera().Stop().ok());
  ASSERT_TRUE(camera().Stop().ok()) << "stopping twice is no error";
  ASSERT_TRUE(camera().Configure({kBright.exposure_s, 0}).ok());
  ASSERT_TRUE(camera().Start().ok());
  EXPECT_TRUE(absl::IsDeadlineExceeded(camera().NextFrame(std::chrono::milliseconds(1)).status()));
}

TEST(CameraRegistry, ListsItsSchemesForAnUnknownOne) {
  const auto schemes = CameraSchemes();
  EXPECT_THAT(schemes, testing::IsSupersetOf({"sim", "replay"}));
  const absl::Status status = OpenRig({.name = "a", .camera_uri = "usb:0"}, SystemClock()).status();
  EXPECT_TRUE(absl::IsInvalidArgument(status));
  for (const std::string& scheme : schemes) {
    EXPECT_THAT(std::string(status.message()), testing::HasSubstr(scheme + ":"));
  }
}

TEST(CameraRegistry, AReplayOfWhatIsNoRecordingIsNotFound) {
  const TemporaryFolder folder;
  EXPECT_TRUE(absl::IsNotFound(
      OpenRig({.name = "a", .camera_uri = "replay:" + folder.path().string()}, SystemClock())
          .status()));
  EXPECT_TRUE(absl::IsInvalidArgument(
      OpenRig({.name = "a", .camera_uri = "replay:"}, SystemClock()).status()));
}

}  // namespace
}  // namespace eyebox::capture
