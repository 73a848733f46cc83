// A rich recording stands in for a rig: half of its frames are measured with, the other half is the
// truth.
#include "service/planner/recording_measurement.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>

#include "capture/camera/sim/sim_rig.h"
#include "capture/plan.h"
#include "service/planner/tradeoff_result.h"
#include "service/steps/record_plan.h"
#include "tests/service/planner/small_rig.h"
#include "tests/service/run_eyebox.h"

namespace eyebox::service {
namespace {

using testing::HasSubstr;

capture::PlanOptions RichPlan() {
  capture::PlanOptions plan;
  plan.levels = 9;
  plan.exposures_s = {0.0125, 0.075};
  plan.repeats = plan.dark_repeats = plan.flat_repeats = plan.disk_repeats = 16;
  plan.disk_diameters_deg = {8};
  return plan;
}

std::filesystem::path Record(const TemporaryFolder& folder, const std::string& name,
                             const capture::PlanOptions& plan) {
  const std::filesystem::path recording = folder / name;
  auto rig = capture::OpenSimRig({.name = "test", .camera_uri = "sim:rift-s-like", .seed = 9},
                                 SmallRig(), SystemClock());
  EXPECT_TRUE(rig.ok()) << rig.status();
  const auto report = RecordPlan(*rig, *capture::MakeGreyPlan(plan), recording, {});
  EXPECT_TRUE(report.ok()) << report.status();
  return recording;
}

class Recorded : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TemporaryFolder;
    recording_ = new std::filesystem::path(Record(*folder_, "rich", RichPlan()));
  }
  static void TearDownTestSuite() {
    delete recording_;
    delete folder_;
  }
  static std::shared_ptr<const RecordedFrames> Frames() {
    auto frames = RecordedFrames::Read(*recording_);
    EXPECT_TRUE(frames.ok()) << frames.status();
    return *frames;
  }

  static TemporaryFolder* folder_;
  static std::filesystem::path* recording_;
};
TemporaryFolder* Recorded::folder_ = nullptr;
std::filesystem::path* Recorded::recording_ = nullptr;

Stimulus Grey(double drive) {
  Stimulus stimulus;
  stimulus.drive = DriveRgb{drive, drive, drive};
  return stimulus;
}

TEST_F(Recorded, HalvesAreOfItsFramesAndOthersForEachSeed) {
  const auto frames = Frames();
  RecordingMeasurement all(frames);
  RecordingMeasurement one(frames, 1);
  RecordingMeasurement again(frames, 1);
  RecordingMeasurement other(frames, 2);
  EXPECT_EQ(all.Limits()->frames, 16);
  EXPECT_EQ(one.Limits()->frames, 8);
  EXPECT_EQ(one.Limits()->drives.size(), 9);
  EXPECT_EQ(one.Limits()->disks_deg, std::vector<double>{8});
  const auto mean = [](RecordingMeasurement& source, int count) {
    const auto stacks = source.Take(Grey(0.5), {count, 0});
    EXPECT_TRUE(stacks.ok()) << stacks.status();
    return (*stacks)[0].mean_dn;
  };
  EXPECT_TRUE(std::ranges::equal(mean(one, 8).pixels(), mean(again, 8).pixels()));
  EXPECT_FALSE(std::ranges::equal(mean(one, 8).pixels(), mean(other, 8).pixels()));
  const auto beyond = one.Take(Grey(0.5), {9, 0});
  EXPECT_THAT(std::string(beyond.status().message()), HasSubstr("8 are there"));
  const auto between = one.Take(Grey(0.51), {1, 0});
  EXPECT_EQ(between.status().code(), absl::StatusCode::kFailedPrecondition);
}

TEST_F(Recorded, TheOtherHalfTellsTheTruthWithinItsNoise) {
  SimulatedMeasurement simulated(SmallRig(), 9);
  const Truth known = *simulated.TruthFor(8);
  RecordingMeasurement measurement(Frames(), 3);
  const auto truth = measurement.TruthFor(8);
  ASSERT_TRUE(truth.ok()) << truth.status();
  EXPECT_NEAR(truth->glare_factor, known.glare_factor, 0.003);
  for (const double drive : {0.3, 0.6, 0.9}) {
    const DriveRgb grey = {drive, drive, drive};
    EXPECT_NEAR(truth->relative_luminance(grey) / known.relative_luminance(grey), 1, 0.02);
  }
  // Up to the scale, which is common.
  double ratios = 0;
  double squares = 0;
  double count = 0;
  for (size_t i = 0; i < known.white.pixels().size(); ++i) {
    const double ratio = truth->white.pixels()[i] / known.white.pixels()[i];
    if (!std::isfinite(ratio)) continue;
    ratios += ratio;
    squares += ratio * ratio;
    ++count;
  }
  const double mean = ratios / count;
  const double variance = squares / count / (mean * mean) - 1;
  EXPECT_NEAR(variance / truth->white_relative_variance, 1, 0.25);
  EXPECT_FALSE(RecordingMeasurement(Frames()).TruthFor(0).ok());
}

TEST_F(Recorded, ATradeoffMeasuresWhatTheRecordingCanGive) {
  TradeoffRequest request;
  request.recording = *recording_;
  request.options.trials = 8;
  const auto result = RunTradeoff(request, {});
  ASSERT_TRUE(result.ok()) << result.status();
  EXPECT_EQ(result->source(), "rich");
  EXPECT_GT(result->lines_size(), 25);
  EXPECT_EQ(result->lines(0).levels(), 9);
  EXPECT_LT(result->median_disagreement(), 0.3);
  const auto told = [&](const std::string& what) {
    return std::ranges::any_of(result->warnings(), [&](const std::string& warning) {
      return warning.find(what) != std::string::npos;
    });
  };
  EXPECT_TRUE(told("33 levels: no level of drive 0.03125"));
  EXPECT_TRUE(told("16 frames: 8 frames of a level are at hand"));
  EXPECT_TRUE(told("trials share"));
  for (const v1::TradeoffLine& line : result->lines()) {
    if (line.lever() != "designed levels") continue;
    EXPECT_GT(line.measured_rms().value(), 0);
  }
}

TEST_F(Recorded, ACancelledTradeoffStopsAfterTheTrialsUnderWay) {
  TradeoffRequest request;
  request.recording = *recording_;
  request.options.trials = 8;
  std::atomic<int> asked = 0;
  Watcher watcher;
  watcher.cancelled = [&asked] { return ++asked > 10; };
  const auto result = RunTradeoff(request, watcher);
  EXPECT_TRUE(absl::IsCancelled(result.status())) << result.status();
  EXPECT_LE(asked, 10 + request.options.trials) << "of hundreds";
}

TEST_F(Recorded, APlanTakesItsPricesFromIt) {
  const std::string scene = EYEBOX_SOURCE_DIR "/fixtures/scenes/requirements";
  const auto scenes = [&] {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(scene)) {
      files.push_back(entry.path());
    }
    std::ranges::sort(files);
    return files;
  }();
  const Outcome planned = RunEyebox("plan --scene " + scenes.front().string() +
                                    " --tolerance 2% --pilot " + recording_->string());
  EXPECT_EQ(planned.exit_code, 0) << planned.err;
  EXPECT_THAT(planned.out, HasSubstr("95 % of errors within"));
  const Outcome neither = RunEyebox("plan --scene " + scenes.front().string());
  EXPECT_EQ(neither.exit_code, 3);
  EXPECT_THAT(neither.err, HasSubstr("--pilot"));
}

TEST(RecordedFramesTest, WhatARecordingLacksIsSaid) {
  const TemporaryFolder folder;
  capture::PlanOptions plan = RichPlan();
  plan.repeats = plan.dark_repeats = plan.disk_repeats = 2;
  plan.flat_repeats = 0;
  const auto no_flats = RecordedFrames::Read(Record(folder, "no_flats", plan));
  EXPECT_EQ(no_flats.status().code(), absl::StatusCode::kFailedPrecondition);
  EXPECT_THAT(std::string(no_flats.status().message()), HasSubstr("record flats"));
  EXPECT_EQ(RecordedFrames::Read(folder.path() / "missing").status().code(),
            absl::StatusCode::kNotFound);
}

}  // namespace
}  // namespace eyebox::service
