// What is left out of a stack, what is filled in for display, and which darks are believed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "optics/reduce/clip_stack.h"
#include "optics/reduce/interpolate_dark.h"
#include "optics/reduce/reduce_level.h"
#include "optics/reduce/repair_defects.h"
#include "tests/optics/forward_model.h"

namespace eyebox::optics {
namespace {

using ::testing::HasSubstr;

constexpr ImageSize kSize{96, 64};
constexpr double kExposure = 0.01;

// Frames of even light; frame 2 is a flash, and in frame 4 a cosmic ray saturates some pixels.
Stack RecordSpoilt(ForwardCamera& camera, int frames, bool spoilt) {
  FrameStacker stacker({kExposure, 0}, camera.Range(), true);
  for (int k = 0; k < frames; ++k) {
    const float rate = spoilt && k == 2 ? 800000.0F : 400000.0F;
    Image<uint16_t> frame = camera.Expose(Image<float>(kSize, rate), kExposure);
    if (spoilt && k == 4) {
      for (int x = 10; x < 20; ++x) frame.at(x, 30) = 4095;
    }
    EXPECT_TRUE(stacker.Add({frame.pixels(), frame.size()}).ok());
  }
  return *stacker.Finish();
}

TEST(ClipStackTest, FlashAndCosmicRayAreLeftOutAndCounted) {
  ForwardCamera camera(kSize, 61);
  const Calibration calibration = camera.Calibrate({kExposure}, 32);
  const Stack raw = RecordSpoilt(camera, 8, true);
  const Stack clipped = *ClipStack(raw, calibration.noise, 5);
  EXPECT_EQ(clipped.rejected_count.at(5, 5), 1);
  EXPECT_EQ(clipped.rejected_count.at(15, 30), 2);
  EXPECT_EQ(raw.saturated_count.at(15, 30), 1);
  EXPECT_EQ(clipped.saturated_count.at(15, 30), 0);
  const auto reduced = *ReduceRate(std::vector{clipped}, calibration);
  EXPECT_EQ(reduced.report.invalid_share, 0);
  const PullStatistics pulls = Pulls(reduced.rate, [](size_t) { return 0.25 * 400000; });
  EXPECT_NEAR(pulls.mean, 0, 4 / std::sqrt(pulls.count));
  EXPECT_NEAR(pulls.rms, 1, 4 / std::sqrt(2 * pulls.count) + 0.01);
  const auto spoilt = *ReduceRate(std::vector{raw}, calibration);
  EXPECT_GT(Pulls(spoilt.rate, [](size_t) { return 0.25 * 400000; }).mean, 5);
}

TEST(ClipStackTest, GoodFramesAreKept) {
  ForwardCamera camera(kSize, 62);
  const Stack raw = RecordSpoilt(camera, 8, false);
  const Stack clipped = *ClipStack(raw, camera.TrueNoise(), 5);
  size_t rejected = 0;
  for (const uint8_t n : clipped.rejected_count.pixels()) rejected += n;
  EXPECT_LE(rejected, 1U);  // 49152 counts at 6e-7 each
  // At 3 sigma some fall, as many above as below: the mean stays, and sigma holds.
  const Calibration calibration = camera.Calibrate({kExposure}, 32);
  const auto reduced = *ReduceRate(std::vector{*ClipStack(raw, calibration.noise, 3)}, calibration);
  const PullStatistics pulls = Pulls(reduced.rate, [](size_t) { return 0.25 * 400000; });
  EXPECT_NEAR(pulls.mean, 0, 4 / std::sqrt(pulls.count));
  EXPECT_NEAR(pulls.rms, 1, 0.04);
}

TEST(ClipStackTest, TwoFramesDoNotSayWhichIsWrong) {
  ForwardCamera camera(kSize, 63);
  const Stack raw = RecordSpoilt(camera, 2, false);
  const Stack clipped = *ClipStack(raw, camera.TrueNoise(), 5);
  EXPECT_TRUE(clipped.rejected_count.empty());
  EXPECT_TRUE(std::ranges::equal(clipped.mean_dn.pixels(), raw.mean_dn.pixels()));
}

TEST(ClipStackTest, TightClipAndMissingExtremesAreRejected) {
  ForwardCamera camera(kSize, 64);
  const Stack raw = RecordSpoilt(camera, 5, false);
  EXPECT_EQ(ClipStack(raw, camera.TrueNoise(), 1).status().code(),
            absl::StatusCode::kInvalidArgument);
  const Stack plain = camera.RecordDark(kExposure, 3);
  EXPECT_THAT(std::string(ClipStack(plain, camera.TrueNoise(), 5).status().message()),
              HasSubstr("keep_extremes"));
}

TEST(RepairDefectsTest, HoleIsFilledFromNeighboursAndStaysInvalid) {
  MeasuredImage image = MakeMeasuredImage({7, 5}, "cd/m2");
  for (int x = 0; x < 7; ++x) {
    for (int y = 0; y < 5; ++y) {
      image.value.at(x, y) = static_cast<float>(x);
      image.variance.at(x, y) = 1;
    }
  }
  image.mask.at(3, 2) = kDefective;
  image.mask.at(0, 0) = kDefective | kSaturated;
  BlankMaskedPixels(image);
  const MeasuredImage repaired = RepairDefects(image, 2);
  EXPECT_EQ(repaired.value.at(3, 2), 3);
  EXPECT_EQ(repaired.mask.at(3, 2), kDefective | kRepaired);
  EXPECT_TRUE(std::isnan(repaired.variance.at(3, 2)));
  EXPECT_TRUE(std::isnan(repaired.value.at(0, 0)));  // saturation is no hole
  EXPECT_EQ(CountFlagged(repaired, 0xFF), CountFlagged(image, 0xFF));
}

TEST(RepairDefectsTest, OffUnlessAskedFor) {
  ForwardCamera camera(kSize, 65);
  camera.dark_rate_e_s.at(40, 30) = 5e5F;
  const Calibration calibration = camera.Calibrate({kExposure}, 8);
  const std::vector stacks = {camera.Record(Image<float>(kSize, 400000.0F), kExposure, 4)};
  const auto plain = *ReduceLevel(stacks, calibration);
  EXPECT_TRUE(std::isnan(plain.luminance.image.value.at(40, 30)));
  const auto repaired = *ReduceLevel(stacks, calibration, {.repair_defects = true});
  EXPECT_NEAR(repaired.luminance.image.value.at(40, 30), 100000, 3000);
  EXPECT_EQ(repaired.report.invalid_share, plain.report.invalid_share);
  EXPECT_THAT(repaired.luminance.image.history, ::testing::Contains(HasSubstr("RepairDefects(1 ")));
}

class InterpolateDarkTest : public ::testing::Test {
 protected:
  InterpolateDarkTest() : camera_(kSize, 66) {
    for (size_t i = 0; i < kSize.PixelCount(); ++i) {
      camera_.dark_rate_e_s.pixels()[i] = static_cast<float>(500 + 20 * (i % 50));
    }
  }
  ForwardCamera camera_;
};

TEST_F(InterpolateDarkTest, DarksOnALineGiveTheDarkBetweenThem) {
  const Calibration calibration = camera_.Calibrate({0.05, 0.2, 1.0}, 64);
  const auto dark = InterpolateDark(calibration.darks, calibration.defects.defective, {0.5, 0});
  ASSERT_TRUE(dark.ok()) << dark.status();
  const PullStatistics pulls = Pulls(dark->image_dn, [&](size_t i) {
    return camera_.bias_dn + 0.25 * 0.5 * camera_.dark_rate_e_s.pixels()[i];
  });
  EXPECT_NEAR(pulls.mean, 0, 4 / std::sqrt(pulls.count) + 0.02);
  EXPECT_NEAR(pulls.rms, 1, 0.05);
  EXPECT_THAT(dark->image_dn.history.back(), HasSubstr("0.05 s, 0.2 s, 1 s"));
}

TEST_F(InterpolateDarkTest, DarksOffALineAreRefusedWithAdvice) {
  Calibration calibration = camera_.Calibrate({0.05, 0.2, 1.0}, 64);
  for (float& dn : calibration.darks[1].image_dn.value.pixels()) dn += 0.5F;  // the sensor warmed
  const auto dark = InterpolateDark(calibration.darks, calibration.defects.defective, {0.5, 0});
  EXPECT_EQ(dark.status().code(), absl::StatusCode::kFailedPrecondition);
  EXPECT_THAT(std::string(dark.status().message()),
              ::testing::AllOf(HasSubstr("line"), HasSubstr("record darks of this exposure")));
}

TEST_F(InterpolateDarkTest, TwoDarksProveNothing) {
  const Calibration calibration = camera_.Calibrate({0.05, 1.0}, 8);
  EXPECT_THAT(
      std::string(InterpolateDark(calibration.darks, calibration.defects.defective, {0.5, 0})
                      .status()
                      .message()),
      HasSubstr("2 exposures"));
}

TEST_F(InterpolateDarkTest, NothingIsExtrapolated) {
  const Calibration calibration = camera_.Calibrate({0.05, 0.2, 1.0}, 8);
  EXPECT_THAT(std::string(InterpolateDark(calibration.darks, calibration.defects.defective, {2, 0})
                              .status()
                              .message()),
              HasSubstr("outside the darks"));
}

TEST_F(InterpolateDarkTest, ClippedDarksAreNotBelieved) {
  camera_.bias_dn = -5;
  for (float& rate : camera_.dark_rate_e_s.pixels()) rate = 0;
  const Calibration calibration = camera_.Calibrate({0.05, 0.2, 1.0}, 8);
  EXPECT_THAT(
      std::string(InterpolateDark(calibration.darks, calibration.defects.defective, {0.5, 0})
                      .status()
                      .message()),
      HasSubstr("black level"));
}

}  // namespace
}  // namespace eyebox::optics
