#include "service/planner/cheapest.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

#include "service/planner/plan_measurement.h"
#include "tests/service/planner/small_rig.h"

namespace eyebox::service {
namespace {

LeverGrid SmallGrid() {
  LeverGrid grid;
  grid.frames = {1, 4, 16};
  grid.even_levels = {5, 9};
  grid.design_s = {2, 8, 32};
  grid.white_frames = {0, 16};
  grid.orders = {2, 4};
  grid.block_px = {1, 2};
  grid.calibration_frames = {2, 8};
  grid.disk_frames = {1, 8};
  grid.shown_frames = {1, 4, 16};
  grid.map_frames = {1, 16};
  return grid;
}

Predictor PredictorFor(const Need& need) {
  PilotOptions options;
  options.primaries = !need.colours.empty();
  auto predictor = Predictor::Make(SmallPilot(options), need, {});
  EXPECT_TRUE(predictor.ok()) << predictor.status();
  return *std::move(predictor);
}

TEST(FindCheapest, NothingCheaperKeepsTheTolerance) {
  Predictor predictor = PredictorFor({.radius_deg = 12, .disk_deg = 8});
  constexpr double kTolerance = 0.008;
  const auto search = FindCheapest(predictor, kTolerance, {}, SmallGrid());
  ASSERT_TRUE(search.ok()) << search.status();
  ASSERT_TRUE(search->cheapest);
  EXPECT_LE(search->cheapest->prediction.bound_95, kTolerance);
  const auto all = CandidateSettings(predictor, kTolerance, SmallGrid());
  ASSERT_TRUE(all.ok());
  double least_s = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < all->size(); i += 7) {  // a sample: each prediction takes a millisecond
    const auto prediction = predictor.Predict((*all)[i]);
    if (!prediction.ok() || prediction->bound_95 > kTolerance) continue;
    least_s = std::min(least_s, prediction->capture_s);
  }
  EXPECT_LE(search->cheapest->prediction.capture_s, least_s);
}

TEST(FindCheapest, ATighterToleranceCostsMore) {
  Predictor predictor = PredictorFor({.radius_deg = 12});
  double last_s = 0;
  for (const double tolerance : {0.05, 0.01, 0.004}) {
    const auto search = FindCheapest(predictor, tolerance, {}, SmallGrid());
    ASSERT_TRUE(search.ok() && search->cheapest) << tolerance;
    EXPECT_GE(search->cheapest->prediction.capture_s, last_s);
    last_s = search->cheapest->prediction.capture_s;
  }
}

TEST(FindCheapest, WhatCannotBeKeptIsNotPromised) {
  Predictor predictor = PredictorFor({.radius_deg = 12});
  const auto search = FindCheapest(predictor, 1e-6, 20.0, SmallGrid());
  ASSERT_TRUE(search.ok()) << search.status();
  EXPECT_FALSE(search->cheapest);
  ASSERT_TRUE(search->best);
  EXPECT_LE(search->best->prediction.capture_s, 20);
  EXPECT_GT(search->best->prediction.bound_95, 1e-6);
}

TEST(FindCheapest, OneGreyThatNeverVariesIsReadAlone) {
  Need need{.radius_deg = 4, .grey_u = {0.5}, .fixed = true};
  Predictor predictor = PredictorFor(need);
  const auto alone = FindCheapest(predictor, 0.01, {}, SmallGrid());
  ASSERT_TRUE(alone.ok() && alone->cheapest);
  EXPECT_EQ(alone->cheapest->setting.shown.size(), 1U);
  EXPECT_TRUE(alone->cheapest->setting.levels.empty());
  need.fixed = false;
  Predictor varying = PredictorFor(need);
  const auto fitted = FindCheapest(varying, 0.01, {}, SmallGrid());
  ASSERT_TRUE(fitted.ok() && fitted->cheapest);
  EXPECT_TRUE(fitted->cheapest->setting.shown.empty());
  EXPECT_LT(2 * alone->cheapest->prediction.capture_s, fitted->cheapest->prediction.capture_s);
}

TEST(CapturesOf, AreTheFramesThatTheSettingCounts) {
  for (const auto& [primaries, fixed] : {std::pair{false, false}, {true, false}, {false, true}}) {
    Need need{.radius_deg = 12, .disk_deg = 8, .fixed = fixed};
    if (primaries) need.colours = {{0.5, 0.2, 0.1}};
    if (fixed) need.grey_u = {0.2, 0.5};
    Predictor predictor = PredictorFor(need);
    const auto search = FindCheapest(predictor, 0.01, {}, SmallGrid());
    ASSERT_TRUE(search.ok() && search->cheapest);
    const Setting& setting = search->cheapest->setting;
    EXPECT_EQ(setting.primaries, primaries);
    EXPECT_EQ(setting.shown.size(), fixed ? 2U : 0U);
    const CapturePlan plan = CapturesOf(setting, predictor.pilot(), need);
    int frames = 0;
    int coloured = 0;
    for (const CaptureSpec& spec : plan.captures) {
      frames += spec.repeats;
      coloured += spec.series == "red" || spec.series == "green" || spec.series == "blue";
    }
    EXPECT_EQ(frames, FrameCount(setting));
    EXPECT_EQ(coloured > 0, primaries);
    for (const char* series : {"scene-1", "scene-2"}) {
      EXPECT_EQ(std::ranges::count(plan.captures, series, &CaptureSpec::series), fixed) << series;
    }
  }
}

}  // namespace
}  // namespace eyebox::service
