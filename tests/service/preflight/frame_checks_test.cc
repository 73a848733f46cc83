// The checks that look at a few numbers: read-back, stale frames, black level, refresh.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "capture/camera/sim/noise.h"
#include "service/preflight/black_level.h"
#include "service/preflight/read_back.h"
#include "service/preflight/refresh.h"
#include "service/preflight/stale_frames.h"
#include "tests/service/preflight/preflight_bench.h"

namespace eyebox::service {
namespace {

using testing::HasSubstr;

ExposureChange Change(std::vector<double> first_dn) {
  return {.old_exposure_s = 0.001,
          .new_exposure_s = 0.004,
          .old_means_dn = {100, 100.2, 99.9},
          .first_means_dn = std::move(first_dn),
          .new_means_dn = {400, 400.1, 399.9}};
}

TEST(StaleFrames, AreCountedUpToTheLastThatIsNotNew) {
  const auto stale = [](std::vector<double> first_dn) {
    return CheckStaleFrames(std::vector{Change(std::move(first_dn))}).measured->value;
  };
  EXPECT_EQ(stale({400, 400.2, 399.8}), 0);
  EXPECT_EQ(stale({100, 400, 400}), 1);
  EXPECT_EQ(stale({100, 100, 400}), 2);
  EXPECT_EQ(stale({250, 400, 400}), 1) << "half of each exposure";
  EXPECT_EQ(stale({400, 100, 400}), 2);
}

TEST(StaleFrames, InEitherDirectionFail) {
  const Check check = CheckStaleFrames(std::vector{Change({400, 400}), Change({100, 400})});
  EXPECT_EQ(check.verdict, Verdict::kFailed);
  EXPECT_THAT(check.remedy, HasSubstr("drop 1 frames"));
}

TEST(StaleFrames, AreNotLookedForWhereTheLightDoesNotChange) {
  ExposureChange same = Change({400, 400});
  same.old_means_dn = same.new_means_dn;
  EXPECT_EQ(CheckStaleFrames(std::vector{same}).verdict, Verdict::kSkipped);
  EXPECT_EQ(CheckStaleFrames(std::vector{Change({})}).verdict, Verdict::kSkipped);
  EXPECT_EQ(CheckStaleFrames({}).verdict, Verdict::kSkipped);
  same.old_means_dn = {NAN};
  EXPECT_EQ(CheckStaleFrames(std::vector{same}).verdict, Verdict::kSkipped);
}

std::vector<uint16_t> Dark(double level_dn, double noise_dn, double wall_dn) {
  capture::NoiseSource noise({7});
  std::vector<uint16_t> counts(20000);
  for (uint16_t& count : counts) {
    const double value = level_dn + noise_dn * noise.Gaussian();
    count = static_cast<uint16_t>(std::floor(std::max(value, wall_dn) + 0.5));
  }
  return counts;
}

TEST(BlackLevel, WithRoomBelowPasses) {
  for (const double noise_dn : {0.1, 0.6, 3.0, 12.0}) {
    for (const double level_dn : {64.0, 64.3, 64.5}) {
      const Check check = CheckBlackLevel(Dark(level_dn, noise_dn, 0), 12);
      EXPECT_EQ(check.verdict, Verdict::kPassed) << level_dn << " " << noise_dn << check.cause;
    }
  }
}

TEST(BlackLevel, WithAWallAtZeroFails) {
  for (const double level_dn : {-3.0, 0.0, 3.0, 6.0}) {
    EXPECT_THAT(CheckBlackLevel(Dark(level_dn, 3, 0), 12).cause, HasSubstr("stand at 0"))
        << level_dn;
  }
}

TEST(BlackLevel, WithAWallAboveZeroFails) {
  const Check check = CheckBlackLevel(Dark(32, 3, 32), 12);
  EXPECT_THAT(check.cause, HasSubstr("clamped above 0"));
  EXPECT_EQ(check.measured->value, 0);
}

TEST(BlackLevel, ForgivesAFewDeadAndHotPixels) {
  std::vector<uint16_t> counts = Dark(64, 3, 0);
  for (size_t i = 0; i < 10; ++i) counts[i] = 0, counts[100 + i] = 4095;
  EXPECT_EQ(CheckBlackLevel(counts, 12).verdict, Verdict::kPassed);
}

TEST(BlackLevel, OfExtremesFails) {
  EXPECT_THAT(CheckBlackLevel(std::vector<uint16_t>(100, 4095), 12).cause, HasSubstr("not dark"));
  EXPECT_THAT(CheckBlackLevel(std::vector<uint16_t>(100, 0), 12).cause, HasSubstr("stand at 0"));
  EXPECT_THAT(CheckBlackLevel({}, 12).cause, HasSubstr("no dark frame"));
  EXPECT_EQ(CheckBlackLevel(std::vector<uint16_t>(100, 16), 8).verdict, Verdict::kPassed);
  EXPECT_THAT(CheckBlackLevel(std::vector<uint16_t>(1, 65535), 16).cause, HasSubstr("not dark"));
}

TEST(ReadBackCheck, CountsWhatDiffersAndTellsTheFirst) {
  const capture::CameraSettings asked = {.exposure_s = 0.01, .black_level = 5};
  const auto cause = [&asked](auto change) {
    ReadBack pair = {asked, asked};
    change(pair.reported);
    return CheckReadBack(std::vector{ReadBack{asked, asked}, pair}).cause;
  };
  EXPECT_EQ(cause([](auto& reported) { reported.exposure_s *= 1.00005; }), "");
  EXPECT_THAT(cause([](auto& reported) { reported.exposure_s *= 1.01; }), HasSubstr("exposure_s"));
  EXPECT_THAT(cause([](auto& reported) { reported.exposure_s = NAN; }), HasSubstr("exposure_s"));
  EXPECT_THAT(cause([](auto& reported) { reported.gain_db = 1; }), HasSubstr("gain_db"));
  EXPECT_THAT(cause([](auto& reported) { reported.black_level.reset(); }),
              HasSubstr("black_level"));
  EXPECT_THAT(cause([](auto& r) { r.trigger = capture::TriggerSource::kFreeRun; }),
              HasSubstr("trigger"));
  EXPECT_EQ(CheckReadBack({}).verdict, Verdict::kFailed);
}

capture::StrobeMeasurement Strobe(double period_s, double sigma_s) {
  return {.strobed = true, .period_s = period_s, .period_sigma_s = sigma_s, .duty = 0.2};
}

TEST(Refresh, WithoutPhotodiodeIsSkippedAndAnErrorIsTold) {
  EXPECT_EQ(CheckRefresh({}).verdict, Verdict::kSkipped);
  const auto clipped = absl::FailedPreconditionError("every sample is clipped");
  EXPECT_THAT(CheckRefresh(clipped).cause, HasSubstr("every sample is clipped"));
  EXPECT_EQ(CheckWholePeriods(clipped, std::vector{0.01}).verdict, Verdict::kSkipped);
}

TEST(Refresh, ThatIsKnownBadlyFails) {
  EXPECT_EQ(CheckRefresh(Strobe(0.01, 9e-6)).verdict, Verdict::kPassed);
  EXPECT_THAT(CheckRefresh(Strobe(0.01, 2e-5)).cause, HasSubstr("0.2 % only"));
}

TEST(WholePeriods, PrintsBoundAndRemedyOfEachExposureThatIsNone) {
  const Check check = CheckWholePeriods(Strobe(0.01, 1e-8), std::vector{0.02, 0.025, 0.105});
  EXPECT_EQ(check.verdict, Verdict::kFailed);
  EXPECT_NEAR(FigureOf(check, "bound_of_0.025_s"), 1 / 2.5, 1e-12);
  EXPECT_THAT(check.cause, HasSubstr("10.500 refresh periods"));
  EXPECT_THAT(check.remedy, HasSubstr("0.03 s instead of 0.025 s"));
  EXPECT_EQ(CheckWholePeriods(Strobe(0.01, 1e-8), std::vector{0.02, 0.1}).verdict,
            Verdict::kPassed);
  EXPECT_EQ(CheckWholePeriods(Strobe(0.01, 1e-8), std::vector{std::nan("")}).verdict,
            Verdict::kFailed);
}

}  // namespace
}  // namespace eyebox::service
