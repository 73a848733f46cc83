#include "capture/run/settle.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace eyebox::capture {
namespace {

using testing::HasSubstr;

// Frames every 10 ms whose mean is 100 DN and an afterglow that falls with `tau_s`.
bool AddGlowing(SettleWatch& watch, int frame, double glow_dn, double tau_s) {
  FrameMetadata metadata;
  metadata.monotonic_time_ns = 500 + frame * int64_t{10'000'000};
  const double mean = 100 + glow_dn * std::exp(-0.01 * frame / tau_s);
  return watch.Add(metadata, {.mean_dn = mean, .sigma_dn = 0.01});
}

int FramesUntilSettled(SettleWatch& watch, double glow_dn, double tau_s) {
  for (int frame = 0; frame < 100000; ++frame) {
    if (AddGlowing(watch, frame, glow_dn, tau_s)) return frame + 1;
  }
  return -1;
}

TEST(Settle, ASceneThatStandsTakesOneWindow) {
  SettleWatch watch({.window_s = 0.1});
  EXPECT_EQ(FramesUntilSettled(watch, 0, 1), 11);
  EXPECT_TRUE(watch.Result().settled);
  EXPECT_NEAR(watch.Result().seconds, 0.1, 1e-12);
  EXPECT_EQ(watch.Result().frames, 11);
}

TEST(Settle, AnAfterglowIsWaitedFor) {
  SettleWatch watch({.window_s = 0.1, .agree_relative = 1e-3});
  ASSERT_GT(FramesUntilSettled(watch, 50, 0.2), 0);
  EXPECT_TRUE(watch.Result().settled);
  // 50 DN exp(-t / 0.2 s) (exp(0.5) - 1) falls below 0.142 DN at 1.09 s.
  EXPECT_NEAR(watch.Result().seconds, 1.09, 0.03);
  EXPECT_LT(50 * std::exp(-watch.Result().seconds / 0.2), 0.3);
}

TEST(Settle, SlowPanelsRisingAreWaitedForToo) {
  SettleWatch watch({});
  ASSERT_GT(FramesUntilSettled(watch, -50, 0.2), 0);
  EXPECT_GT(watch.Result().seconds, 0.8);
}

TEST(Settle, AtLeastTheFixedTimeIsWaited) {
  SettleWatch watch({.least_s = 0.5});
  ASSERT_GT(FramesUntilSettled(watch, 0, 1), 0);
  EXPECT_NEAR(watch.Result().seconds, 0.5, 0.011);
}

TEST(Settle, GivesUpAfterTheLongestTimeAndSaysSo) {
  SettleWatch watch({.longest_s = 2, .window_s = 0.1});
  ASSERT_GT(FramesUntilSettled(watch, 5000, 3), 0);
  EXPECT_FALSE(watch.Result().settled);
  EXPECT_NEAR(watch.Result().seconds, 2, 0.011);
  EXPECT_GT(watch.Result().change_relative, 0.01);
}

TEST(Settle, AClockThatStandsStillEndsByTheNumberOfFrames) {
  SettleWatch watch({.most_frames = 7});
  FrameMetadata metadata;
  int frames = 1;
  while (!watch.Add(metadata, {.mean_dn = 100, .sigma_dn = 1})) ++frames;
  EXPECT_EQ(frames, 7);
  EXPECT_FALSE(watch.Result().settled);
}

TEST(Settle, FramesThatDoNotCountAreBoundedToo) {
  SettleWatch watch({.most_frames = 3});
  EXPECT_FALSE(watch.Skip());
  EXPECT_FALSE(watch.Skip());
  EXPECT_TRUE(watch.Skip());
  EXPECT_FALSE(watch.Result().settled);
}

TEST(Settle, TheCamerasOwnClockCountsWhereThereIsOne) {
  SettleWatch watch({.window_s = 0.1});
  bool done = false;
  for (int frame = 0; !done; ++frame) {
    FrameMetadata metadata;
    metadata.device_time_ns = frame * int64_t{50'000'000};
    metadata.monotonic_time_ns = 1;  // all were received at once
    done = watch.Add(metadata, {.mean_dn = 100, .sigma_dn = 1});
  }
  EXPECT_EQ(watch.Result().frames, 3);
  EXPECT_TRUE(watch.Result().settled);
}

TEST(Settle, RefusesOptionsByName) {
  const auto message = [](const SettleOptions& options) {
    return std::string(options.Validate().message());
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(SettleOptions().Validate().ok());
  EXPECT_THAT(message({.least_s = -1}), HasSubstr("least_s"));
  EXPECT_THAT(message({.least_s = 3, .longest_s = 2}), HasSubstr("longest_s"));
  EXPECT_THAT(message({.most_frames = 1}), HasSubstr("most_frames"));
  EXPECT_THAT(message({.window_s = nan}), HasSubstr("window_s"));
  EXPECT_THAT(message({.agree_sigmas = -1}), HasSubstr("agree_sigmas"));
  EXPECT_THAT(message({.agree_relative = nan}), HasSubstr("agree_relative"));
}

}  // namespace
}  // namespace eyebox::capture
