#include "service/planner/predict_error.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "service/planner/measure_setting.h"
#include "service/steps/reference_disk.h"
#include "tests/service/planner/small_rig.h"

namespace eyebox::service {
namespace {

Stimulus White() {
  Stimulus white;
  white.drive = DriveRgb{1, 1, 1};
  return white;
}

Setting SettingOf(int levels, int frames, FieldTier tier, int size) {
  Setting setting;
  setting.name = "test";
  setting.levels = EvenLevels(levels, {frames, frames, frames});
  setting.tier = tier;
  setting.tier_size = size;
  setting.disk_frames = frames;
  setting.table_size = 64;
  return setting;
}

TEST(SimulatedMeasurement, AsksForTheSameFramesTwiceAndForTheFirstOfMore) {
  SimulatedMeasurement source(SmallRig(), 3);
  SimulatedMeasurement again(SmallRig(), 3);
  const auto more = again.Take(White(), {4, 0, 0});
  const auto few = source.Take(White(), {1, 0, 0});
  const auto same = again.Take(White(), {1, 0, 0});
  ASSERT_TRUE(more.ok() && few.ok() && same.ok());
  ASSERT_EQ(few->size(), 1U);
  EXPECT_TRUE(std::ranges::equal((*few)[0].mean_dn.pixels(), (*same)[0].mean_dn.pixels()));
  EXPECT_EQ((*more)[0].frames, 4);
}

TEST(LuminanceVariance, IsWhatReductionStates) {
  SimulatedMeasurement source(SmallRig(), 1);
  const Pilot pilot = SmallPilot();
  const auto calibration = source.CalibrationOf(8);
  ASSERT_TRUE(calibration.ok());
  for (const double drive : {0.2, 0.6, 1.0}) {
    Stimulus grey;
    grey.drive = DriveRgb{drive, drive, drive};
    const auto level = source.Measure(grey, 2);
    ASSERT_TRUE(level.ok()) << level.status();
    const DiskReading reading = ReadReferenceDisk(level->luminance, **calibration, drive);
    double stated = 0;
    double luminance = 0;
    for (size_t i = 0; i < reading.luminance.size(); ++i) {
      stated += reading.own_variance[i] / static_cast<double>(reading.luminance.size());
      luminance += reading.luminance[i] / static_cast<double>(reading.luminance.size());
    }
    const double predicted =
        LuminanceVariance(pilot, luminance, pilot.response_at_reference, {2, 2, 2}, 8);
    EXPECT_NEAR(predicted / stated, 1, 0.08) << drive;
  }
}

TEST(LuminanceVariance, IsInfiniteWhereEveryExposureSaturates) {
  const Pilot pilot = SmallPilot();
  EXPECT_TRUE(std::isinf(LuminanceVariance(pilot, 1e4, pilot.response_at_reference, {4, 4, 4}, 8)));
  EXPECT_TRUE(std::isinf(LuminanceVariance(pilot, 59, pilot.response_at_reference, {0, 0, 4}, 8)));
}

// Over trials on other sensors.
double MeasuredRms(const Setting& setting, const Need& need, int trials) {
  double sum = 0;
  const ManualClock clock;
  for (int t = 0; t < trials; ++t) {
    SimulatedMeasurement source(SmallRig(), 100 + static_cast<uint64_t>(t));
    const auto region = RegionPixels(source.Size(), source.Geometry(), need.radius_deg);
    const auto truth = source.TruthFor(need.disk_deg);
    const auto measured = MeasureSetting(source, setting, need, region, clock);
    EXPECT_TRUE(truth.ok() && measured.ok()) << measured.status();
    const auto errors = ErrorsOf(*measured, *truth, need, region);
    double square = 0;
    for (const double error : errors) square += error * error;
    sum += square / static_cast<double>(errors.size()) / trials;
  }
  return std::sqrt(sum);
}

class Predicted : public testing::TestWithParam<std::pair<Setting, Need>> {};

TEST_P(Predicted, ErrorIsWhatIsMeasured) {
  const auto& [setting, need] = GetParam();
  PilotOptions options;
  options.primaries = !need.colours.empty();
  auto predictor = Predictor::Make(SmallPilot(options), need, {});
  ASSERT_TRUE(predictor.ok()) << predictor.status();
  const auto prediction = predictor->Predict(setting);
  ASSERT_TRUE(prediction.ok()) << prediction.status();
  const auto rms = predictor->PredictRms(setting);
  EXPECT_DOUBLE_EQ(*rms, prediction->rms);
  EXPECT_GT(prediction->bound_95, prediction->rms);
  const auto share = predictor->ShareWithin(setting, prediction->bound_95);
  EXPECT_NEAR(*share, 0.95, 1e-3);
  // Twelve trials tell their rms to a fifth. Fits of primaries that end at v0 = 0, as half of
  // them do where the display has no cutoff, err less than free ones, which the prediction is for.
  const double ratio = prediction->rms / MeasuredRms(setting, need, 12);
  EXPECT_GT(ratio, 0.65);
  EXPECT_LT(ratio, setting.primaries ? 1.6 : 1.35);
}

Setting WithPrimaries(Setting setting) {
  setting.primaries = true;
  return setting;
}
// What is shown, a few frames of the shortest exposure each, instead of levels.
Setting Showing(const std::vector<DriveRgb>& drives, int white_frames, FieldTier tier, int size) {
  Setting setting = SettingOf(5, white_frames, tier, size);
  if (white_frames > 0) {
    setting.levels = {{1, {white_frames, 0, 0}}};
  } else {
    setting.levels.clear();
  }
  for (const DriveRgb& drive : drives) setting.shown.push_back({drive, {2, 0, 0}});
  setting.disk_frames = 0;
  return setting;
}
const Need kGrey{.radius_deg = 15};
const Need kDisk{.radius_deg = 15, .disk_deg = 8};
const Need kOne{.radius_deg = 4, .grey_u = {0.3}};
const Need kColours{.radius_deg = 15, .colours = {{0.6, 0.3, 0.2}, {0.1, 0.5, 0.9}}};

INSTANTIATE_TEST_SUITE_P(
    Settings, Predicted,
    testing::Values(std::pair(SettingOf(9, 2, FieldTier::kNone, 0), kGrey),
                    std::pair(SettingOf(9, 1, FieldTier::kBlocks, 1), kGrey),
                    std::pair(SettingOf(5, 2, FieldTier::kSmooth, 4), kDisk),
                    std::pair(SettingOf(5, 1, FieldTier::kNone, 0), kOne),
                    std::pair(WithPrimaries(SettingOf(5, 2, FieldTier::kSmooth, 4)), kColours),
                    std::pair(Showing({{0.5, 0.5, 0.5}}, 0, FieldTier::kNone, 0), kOne),
                    std::pair(Showing({{0.4, 0.4, 0.4}, {0.8, 0.8, 0.8}}, 0, FieldTier::kBlocks, 1),
                              kGrey),
                    std::pair(Showing({{0.5, 0.5, 0.5}}, 2, FieldTier::kSmooth, 4), kDisk),
                    std::pair(Showing({{0.8, 0.6, 0.5}, {0.4, 0.7, 0.9}}, 1, FieldTier::kBlocks, 2),
                              kColours)));

}  // namespace
}  // namespace eyebox::service
