#include "tests/contract/camera_contract.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

namespace eyebox::capture {
namespace {

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
  EXPECT_TRUE(absl::IsFailedPrecondition(camera().NextFrame(GetParam().timeout).status()));
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
    const auto frame = camera().NextFrame(GetParam().timeout);
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

}  // namespace
}  // namespace eyebox::capture
