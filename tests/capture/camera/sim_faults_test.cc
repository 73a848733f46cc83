#include "capture/camera/sim/faults.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "capture/camera/sim/sim_rig.h"

namespace eyebox::capture {
namespace {

using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;

class SimFaultsRig : public testing::Test {
 protected:
  void Open(const std::string& faults, bool present = true) {
    const RigConfig config = {
        .name = "test", .camera_uri = "sim:rift-s-like?fault=" + faults, .seed = 3};
    const auto parameters = SimParametersOf(config);
    ASSERT_TRUE(parameters.ok()) << parameters.status();
    auto rig = OpenSimRig(config, *parameters, &clock_);
    ASSERT_TRUE(rig.ok()) << rig.status();
    rig_ = *std::move(rig);
    CaptureSpec grey;
    grey.stimulus.drive = DriveRgb{0.5, 0.5, 0.5};
    if (!present) return;
    ASSERT_TRUE(rig_.presenter->Present(grey).ok());
  }
  std::vector<Frame> Take(double exposure_s, int count) {
    EXPECT_TRUE(rig_.camera->Stop().ok());
    EXPECT_TRUE(rig_.camera->Configure({.exposure_s = exposure_s}).ok());
    EXPECT_TRUE(rig_.camera->Start().ok());
    std::vector<Frame> frames;
    for (int i = 0; i < count; ++i) {
      EXPECT_TRUE(rig_.camera->Trigger().ok());
      frames.push_back(*rig_.camera->NextFrame(std::chrono::milliseconds(1)));
    }
    return frames;
  }
  static double Mean(const Frame& frame) {
    const auto pixels = frame.view.pixels_dn;
    return std::accumulate(pixels.begin(), pixels.end(), 0.0) / static_cast<double>(pixels.size());
  }
  double Mean(double exposure_s) { return Mean(Take(exposure_s, 1)[0]); }

  ManualClock clock_;
  Rig rig_;
};

TEST_F(SimFaultsRig, AutomaticExposureLeavesTheMeanAtHalfScale) {
  Open("auto-exposure");
  EXPECT_NEAR(Mean(0.001), 2047, 30);
  EXPECT_NEAR(Mean(0.03), 2047, 30);
}

TEST_F(SimFaultsRig, GammaKeepsFullScaleAndLiftsTheDark) {
  Open("gamma", false);
  EXPECT_NEAR(Mean(0.001), 4095 * std::pow(64.0 / 4095, 0.45), 3);
}

TEST_F(SimFaultsRig, StaleFramesAreOfTheExposureBeforeTheChange) {
  Open("stale-frames");
  const double long_dn = Mean(Take(0.02, 3).back());
  const auto frames = Take(0.005, 3);
  EXPECT_NEAR(Mean(frames[0]), long_dn, 2);
  EXPECT_NEAR(Mean(frames[1]), long_dn, 2);
  EXPECT_NEAR(Mean(frames[2]) - 64, (long_dn - 64) / 4, 2);
  EXPECT_EQ(frames[0].metadata.exposure_reported_s, 0.005) << "the register says the new one";
}

TEST_F(SimFaultsRig, ClampedBlackPutsHalfOfTheDarkAtZero) {
  Open("clamped-black", false);
  const Frame frame = Take(0.001, 1)[0];
  const auto zeros = std::ranges::count(frame.view.pixels_dn, 0);
  EXPECT_GT(static_cast<double>(zeros) / 19200, 0.5);
}

TEST_F(SimFaultsRig, StrobeChangesNothingOverWholePeriodsAndMuchOverHalfOnes) {
  Open("strobe");
  const double whole_dn = Mean(2.0 / 90);
  std::vector<double> whole, half;
  for (const Frame& frame : Take(2.0 / 90, 8)) whole.push_back(Mean(frame) / whole_dn);
  for (const Frame& frame : Take(0.5 / 90, 8)) half.push_back(Mean(frame) / whole_dn);
  EXPECT_THAT(whole, Each(testing::DoubleNear(1, 0.005)));
  EXPECT_GT(*std::ranges::max_element(half) - *std::ranges::min_element(half), 0.1);
}

TEST_F(SimFaultsRig, StuckGainReadsBackWhatTheCameraHas) {
  Open("stuck-gain");
  const auto set = rig_.camera->Configure({.exposure_s = 0.01});
  ASSERT_TRUE(set.ok()) << set.status();
  EXPECT_EQ(set->gain_db, 6);
}

TEST(SimFaultStages, ARollingShutterShiftsTheFlashFromRowToRow) {
  const SimFaults faults = {.strobe_period_s = 0.01, .strobe_duty = 0.5, .row_time_s = 0.005};
  const Image<double> flashed =
      Flashed(faults, Image<double>({.width_px = 1, .height_px = 4}, 10.0), 0, 0.005);
  std::vector<double> rows(flashed.pixels().begin(), flashed.pixels().end());
  EXPECT_THAT(rows, ElementsAre(testing::DoubleNear(20, 1e-9), testing::DoubleNear(0, 1e-9),
                                testing::DoubleNear(20, 1e-9), testing::DoubleNear(0, 1e-9)));
}

TEST(SimFaultStages, AGridOfWholePixelsHasNoBeat) {
  const SimFaults in_step = {.display_pixel_px = 1, .display_pixel_fill = 0.4};
  const Image<double> grid = DisplayGrid(in_step, {.width_px = 8, .height_px = 5});
  for (const double value : grid.pixels()) EXPECT_NEAR(value, 1, 1e-12);
  const SimFaults beating = {.display_pixel_px = 0.9, .display_pixel_fill = 0.4};
  const Image<double> beat = DisplayGrid(beating, {.width_px = 90, .height_px = 90});
  const auto pixels = beat.pixels();
  EXPECT_NEAR(std::accumulate(pixels.begin(), pixels.end(), 0.0) / 8100, 1, 1e-3);
  // The first alias of the fundamental lies at 1 / 0.9 - 1, a period of 9 pixels.
  EXPECT_NEAR(beat.at(3, 0), beat.at(12, 0), 1e-9);
  EXPECT_GT(*std::ranges::max_element(beat.row(0)), 1.05 * *std::ranges::min_element(beat.row(0)));
}

TEST(SimFaultStages, AreKnownByNameAndUnknownOnesListThem) {
  for (const std::string& name : SimFaultNames()) {
    EXPECT_TRUE(ParseFaults("fault=" + name).ok()) << name;
  }
  const auto both = ParseFaults("fault=gamma,moire");
  ASSERT_TRUE(both.ok()) << both.status();
  EXPECT_EQ(both->gamma, 0.45);
  EXPECT_GT(both->display_pixel_px, 0);
  for (const char* query : {"fault=", "fault=gamma,", "fault=smoke"}) {
    EXPECT_THAT(std::string(ParseFaults(query).status().message()), HasSubstr("clamped-black"));
  }
  EXPECT_THAT(std::string(ParseFaults("gamma").status().message()), HasSubstr("?fault=gamma"));
}

TEST(SimFaultStages, OutOfRangeAreRefusedByName) {
  SimParameters parameters;
  parameters.faults.gamma = NAN;
  EXPECT_THAT(std::string(parameters.Validate().message()), HasSubstr("faults.gamma"));
}

}  // namespace
}  // namespace eyebox::capture
