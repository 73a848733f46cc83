#include "service/steps/levels.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>

#include "service/steps/calibrate.h"
#include "tests/service/recorded_rig.h"

namespace eyebox::service {
namespace {

using testing::HasSubstr;
using testing::Lt;
using testing::SizeIs;

struct Bench {
  std::unique_ptr<capture::RecordingReader> reader;
  optics::Calibration calibration;
};

Bench Open(const std::filesystem::path& recording) {
  Bench bench;
  bench.reader = *capture::RecordingReader::Open(recording);
  auto calibration = CalibrateCamera(*bench.reader, {});
  EXPECT_TRUE(calibration.ok()) << calibration.status();
  bench.calibration = *std::move(calibration);
  return bench;
}

TEST(GreyLevelReduction, LevelsRiseAndTheBrightestIsTheReference) {
  const Bench bench = Open(RecordedRig());
  const auto levels = ReduceGreyLevels(*bench.reader, "", bench.calibration, {});
  ASSERT_TRUE(levels.ok()) << levels.status();
  ASSERT_THAT(levels->drives, SizeIs(17));
  EXPECT_THAT(levels->warnings, SizeIs(0));
  for (size_t i = 1; i < levels->drives.size(); ++i) {
    EXPECT_LT(levels->drives[i - 1], levels->drives[i]);
    EXPECT_LT(levels->series.readings[i - 1].luminance, levels->series.readings[i].luminance);
  }
  EXPECT_EQ(levels->reference.drive, 1);
  EXPECT_EQ(levels->Field().LocationCount(), levels->size.PixelCount());
}

TEST(GreyLevelReduction, ALevelThatSaturatesEveryExposureIsLeftOutWithAWarning) {
  const TemporaryFolder folder;
  // 0.075 s alone: white overfills the well four times.
  const Bench bench =
      Open(Record(folder.path(), "recording", {.levels = 9, .exposures_s = {0.075}}));
  const auto levels = ReduceGreyLevels(*bench.reader, "", bench.calibration, {});
  ASSERT_TRUE(levels.ok()) << levels.status();
  EXPECT_THAT(levels->drives.size(), Lt(9U));
  EXPECT_EQ(levels->drives.size() + levels->warnings.size(), 9U);
  EXPECT_THAT(levels->warnings.back(), AllOf(HasSubstr("drive 1 "), HasSubstr("shorter")));
  EXPECT_LT(levels->reference.drive, 1);
}

TEST(GreyLevelReduction, NoUsableLevelIsRejectedWithTheReason) {
  const TemporaryFolder folder;
  const Bench bench = Open(
      Record(folder.path(), "recording", {.levels = 2, .exposures_s = {0.0125}, .repeats = 4}));
  auto calibration = bench.calibration;
  for (uint8_t& defective : calibration.defects.defective.pixels()) defective = 1;
  const auto levels = ReduceGreyLevels(*bench.reader, "", calibration, {});
  EXPECT_TRUE(absl::IsFailedPrecondition(levels.status())) << levels.status();
  EXPECT_THAT(std::string(levels.status().message()), HasSubstr("left out"));
}

TEST(ChooseSeries, TakesTheMainOneAndPassesOnWhatWasAsked) {
  const auto reader = capture::RecordingReader::Open(RecordedRig());
  ASSERT_TRUE(reader.ok());
  EXPECT_EQ(*ChooseSeries(**reader, std::nullopt), "");
  EXPECT_EQ(*ChooseSeries(**reader, "other"), "other");
  EXPECT_TRUE(absl::IsNotFound(LightCaptures(**reader, "other").status()));
}

}  // namespace
}  // namespace eyebox::service
