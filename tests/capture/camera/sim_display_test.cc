#include "capture/camera/sim/display.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace eyebox::capture {
namespace {

constexpr ImageSize kSize = {.width_px = 160, .height_px = 120};

TEST(Activation, GoesFromZeroToOne) {
  for (const double cutoff : {0.0, 0.03, 0.3}) {
    const ChannelParameters channel = {.gamma = 2.3, .cutoff_drive = cutoff};
    EXPECT_EQ(Activation(channel, 0), 0);
    EXPECT_EQ(Activation(channel, cutoff), 0);
    EXPECT_EQ(Activation(channel, 1), 1);
    EXPECT_GT(Activation(channel, cutoff + 1e-6), 0);
  }
}

TEST(Activation, IsAPowerAboveTheCutoff) {
  const ChannelParameters channel = {.gamma = 2, .cutoff_drive = 0.2};
  EXPECT_NEAR(Activation(channel, 0.6), 0.25, 1e-15);
}

TEST(DisplayLuminance, PeaksAtTheSumOfBackgroundAndRange) {
  const DisplayParameters display;
  EXPECT_DOUBLE_EQ(DisplayLuminance(display, {0, 0, 0}), 0.19);
  EXPECT_NEAR(DisplayLuminance(display, {1, 1, 1}), 59, 1e-12);
}

TEST(DisplayLuminance, OfThePrimariesAddsUpToWhite) {
  const DisplayParameters display;
  const double background = DisplayLuminance(display, {0, 0, 0});
  const double sum = DisplayLuminance(display, {0.5, 0, 0}) +
                     DisplayLuminance(display, {0, 0.5, 0}) +
                     DisplayLuminance(display, {0, 0, 0.5}) - 2 * background;
  EXPECT_NEAR(sum, DisplayLuminance(display, {0.5, 0.5, 0.5}), 1e-12);
}

TEST(Nonuniformity, IsOneAtTheImageCentreAndFallsOffSmoothly) {
  const Image<double> odd = Nonuniformity({}, {.width_px = 161, .height_px = 121});
  EXPECT_DOUBLE_EQ(odd.at(80, 60), 1);
  const Image<double> g = Nonuniformity({}, kSize);
  const double centre = (g.at(79, 59) + g.at(80, 59) + g.at(79, 60) + g.at(80, 60)) / 4;
  EXPECT_NEAR(centre, 1, 1e-4);
  EXPECT_LT(g.at(0, 0), 0.85);
  for (int x = 1; x < kSize.width_px; ++x) {
    EXPECT_LT(std::abs(g.at(x, 60) - g.at(x - 1, 60)), 0.005);
  }
}

TEST(Nonuniformity, IsOffCentre) {
  const Image<double> g = Nonuniformity({}, kSize);
  EXPECT_GT(g.at(159, 60), g.at(0, 60) + 0.02);
}

TEST(DrawStimulus, DiskCoversItsSolidAngle) {
  const SimParameters parameters;
  const Stimulus disk = {
      .pattern = StimulusPattern::kDisk, .diameter_deg = 10, .drive = DriveRgb{1, 1, 1}};
  const auto scene = DrawStimulus(parameters.display, parameters.geometry, kSize, disk);
  ASSERT_TRUE(scene.ok()) << scene.status();
  double lit = 0;  // pixels, those at the edge by their share
  for (const double luminance : scene->pixels()) lit += (luminance - 0.19) / 58.81;
  const double radius_px = 219.8 * std::tan(5 * std::numbers::pi / 180);
  EXPECT_NEAR(lit, std::numbers::pi * radius_px * radius_px, 0.1 * radius_px);
  EXPECT_NEAR(scene->at(80, 60), 59, 1e-12);
  EXPECT_DOUBLE_EQ(scene->at(0, 0), 0.19);
}

TEST(DrawStimulus, BlackDiskIsTheNegative) {
  const SimParameters parameters;
  const Stimulus disk = {
      .pattern = StimulusPattern::kBlackDisk, .diameter_deg = 10, .drive = DriveRgb{1, 1, 1}};
  const auto scene = DrawStimulus(parameters.display, parameters.geometry, kSize, disk);
  ASSERT_TRUE(scene.ok()) << scene.status();
  EXPECT_NEAR(scene->at(80, 60), 0.19, 1e-12);
  EXPECT_NEAR(scene->at(0, 0), 59, 1e-12);
}

TEST(DrawStimulus, SquaresMeetOnTheAxisAndTheUpperLeftOneIsBright) {
  const DisplayParameters display;
  const PinholeGeometry geometry{
      .focal_length_px = 100, .principal_x_px = 49.5, .principal_y_px = 39.5};
  const double side_deg = std::atan(0.105) * 180 / std::numbers::pi;  // 10.5 px
  const auto scene = DrawStimulus(display, geometry, {100, 80},
                                  {.pattern = StimulusPattern::kCheckerboard,
                                   .diameter_deg = side_deg,
                                   .drive = DriveRgb{1, 1, 1}});
  ASSERT_TRUE(scene.ok()) << scene.status();
  const double white = DisplayLuminance(display, {1, 1, 1});
  const double black = DisplayLuminance(display, {0, 0, 0});
  EXPECT_DOUBLE_EQ(scene->at(49, 39), white);
  EXPECT_DOUBLE_EQ(scene->at(50, 39), black);
  EXPECT_DOUBLE_EQ(scene->at(49, 40), black);
  EXPECT_DOUBLE_EQ(scene->at(50, 40), white);
  EXPECT_DOUBLE_EQ(scene->at(45, 35), white);
  EXPECT_NEAR(scene->at(60, 40), (white + black) / 2, 1e-9) << "half of the pixel";
  EXPECT_DOUBLE_EQ(scene->at(65, 40), black);
  double sum = 0;
  for (const double value : scene->pixels()) sum += value;
  EXPECT_NEAR(sum / 8000, (white + black) / 2, 0.02 * white);
}

TEST(DrawStimulus, RefusesWhatItCannotShow) {
  const SimParameters parameters;
  const auto draw = [&](const Stimulus& stimulus) {
    return DrawStimulus(parameters.display, parameters.geometry, kSize, stimulus).status();
  };
  EXPECT_THAT(std::string(draw({}).message()), testing::HasSubstr("drive"));
  EXPECT_TRUE(absl::IsInvalidArgument(draw({.drive = DriveRgb{0, 1.01, 0}})));
  EXPECT_TRUE(absl::IsInvalidArgument(draw({.drive = DriveRgb{0, std::nan(""), 0}})));
  EXPECT_TRUE(absl::IsInvalidArgument(
      draw({.pattern = StimulusPattern::kDisk, .drive = DriveRgb{1, 1, 1}})));
}

}  // namespace
}  // namespace eyebox::capture
