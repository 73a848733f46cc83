// A display that warms up while it is measured, seen by the reduction of its levels.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include "capture/camera/sim/display.h"
#include "capture/camera/sim/sim_rig.h"
#include "capture/plan.h"
#include "service/steps/calibrate.h"
#include "service/steps/drift.h"
#include "service/steps/levels.h"
#include "service/steps/record_plan.h"
#include "tests/support/restless_display.h"
#include "tests/support/restless_photodiode.h"
#include "tests/support/temporary_folder.h"

namespace eyebox::service {
namespace {

using capture::DisplayFault;
using capture::DisplayMoment;
using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

class DriftStep : public testing::Test {
 protected:
  // Every frame takes 10 ms of the clock. `lost_per_s` of the light is lost in a second.
  // `photodiode`, where there is one, tells what of the light it sees.
  std::unique_ptr<capture::RecordingReader> Record(const std::string& name, double lost_per_s,
                                                   int reference_every = 2,
                                                   const capture::LightAt& photodiode = {}) {
    capture::PlanOptions options;
    options.levels = 9;
    options.dark_repeats = options.flat_repeats = 4;
    options.reference_every = reference_every;
    return Record(name, lost_per_s, *capture::MakeGreyPlan(options), photodiode);
  }

  std::unique_ptr<capture::RecordingReader> Record(const std::string& name, double lost_per_s,
                                                   const CapturePlan& plan,
                                                   const capture::LightAt& photodiode = {}) {
    ManualClock clock;
    capture::SimParameters parameters;
    auto rig = OpenSimRig({.name = "test", .camera_uri = "sim:rift-s-like", .seed = 5}, parameters,
                          &clock);
    EXPECT_TRUE(rig.ok()) << rig.status();
    const auto fault = [lost_per_s](const DisplayMoment& moment) {
      return DisplayFault{.factor = 1 - lost_per_s * static_cast<double>(moment.now_ns) / 1e9};
    };
    capture::MakeRestless(*rig, clock, parameters.sensor.bias_dn, fault);
    if (photodiode) capture::AddPhotodiode(*rig, clock, photodiode, 0.5);
    const auto report = RecordPlan(*rig, plan, folder_.path() / name, {});
    EXPECT_TRUE(report.ok()) << report.status();
    return *capture::RecordingReader::Open(folder_.path() / name);
  }

  // A photodiode that sees the display's own drift, or another.
  static capture::LightAt Sees(double lost_per_s) {
    return [lost_per_s](const CaptureSpec& shown, int64_t now_ns) {
      const double luminance =
          DisplayLuminance(capture::DisplayParameters{}, shown.stimulus.drive.value_or(DriveRgb{}));
      return 50 * luminance * (1 - lost_per_s * static_cast<double>(now_ns) / 1e9);
    };
  }

  static MeasuredLevels Reduce(capture::RecordingReader& recording) {
    const auto calibration = CalibrateCamera(recording, {});
    EXPECT_TRUE(calibration.ok()) << calibration.status();
    auto levels = ReduceGreyLevels(recording, "", *calibration, {});
    EXPECT_TRUE(levels.ok()) << levels.status();
    return *std::move(levels);
  }

  // Largest and smallest luminance of a level of one recording relative to another.
  static std::pair<double, double> Ratios(const MeasuredLevels& a, const MeasuredLevels& b) {
    std::pair<double, double> extremes = {1e9, 0};
    for (size_t i = 1; i < a.series.readings.size(); ++i) {  // level 0 is all noise
      const double ratio = a.series.readings[i].luminance / b.series.readings[i].luminance;
      extremes = {std::min(extremes.first, ratio), std::max(extremes.second, ratio)};
    }
    return extremes;
  }

  const TemporaryFolder folder_;
};

TEST_F(DriftStep, IsMeasuredFromTheReferences) {
  const auto recording = Record("drifting", 0.08);
  const auto measured = MeasureDrift(*recording);
  ASSERT_TRUE(measured.ok()) << measured.status();
  EXPECT_EQ(measured->drift.readings, 6);
  ASSERT_EQ(measured->drift.order, 1);
  const double middle = 1 - 0.08 * measured->drift.middle_s;
  EXPECT_NEAR(measured->drift.per_hour, -0.08 * 3600 / middle, 4 * measured->drift.per_hour_sigma);
  EXPECT_THAT(measured->warnings, Contains(AllOf(HasSubstr("drifted"), HasSubstr("per hour"))));
}

TEST_F(DriftStep, LevelsAreCorrectedToTheMiddleOfTheRecording) {
  const auto steady = Reduce(*Record("steady", 0));
  const auto recording = Record("drifting", 0.08);
  const auto corrected = Reduce(*recording);
  const auto uncorrected = Reduce(*Record("without references", 0.08, 0));
  const auto [raw_low, raw_high] = Ratios(uncorrected, steady);
  EXPECT_GT(raw_high / raw_low, 1.03) << "the drift is worth correcting";
  const auto [low, high] = Ratios(corrected, steady);
  EXPECT_LT(high / low, 1.005);
  const double middle = 1 - 0.08 * MeasureDrift(*recording)->drift.middle_s;
  EXPECT_NEAR(low, middle, 0.005);
  EXPECT_THAT(corrected.warnings, Contains(HasSubstr("drifted")));
  EXPECT_THAT(corrected.reference.reduced.luminance.image.history,
              Contains(HasSubstr("CorrectDrift(order 1")));
}

// Without the references after the fourth level.
CapturePlan WithEarlyReferencesAlone() {
  capture::PlanOptions options;
  options.levels = 9;
  options.dark_repeats = options.flat_repeats = 4;
  options.reference_every = 1;
  CapturePlan plan = *capture::MakeGreyPlan(options);
  int seen = 0;
  std::string last;
  std::erase_if(plan.captures, [&](const CaptureSpec& spec) {
    const bool begins = spec.series == capture::kReferenceSeries && last != spec.series;
    last = spec.series;
    seen += begins ? 1 : 0;
    return spec.series == capture::kReferenceSeries && seen > 5;
  });
  return plan;
}

TEST_F(DriftStep, LevelsBeyondItsReadingsAreSaidAndUncertain) {
  const auto recording = Record("early references", 0.08, WithEarlyReferencesAlone());
  ASSERT_EQ(MeasureDrift(*recording)->drift.order, 1);
  const auto early = Reduce(*recording);
  EXPECT_THAT(early.warnings, Contains(HasSubstr("of 9 levels were shown beyond")));
  const auto amid = Reduce(*Record("references", 0.08));
  EXPECT_THAT(amid.warnings, Not(Contains(HasSubstr("beyond"))));
  const auto most_uncertain = [](const MeasuredLevels& levels) {
    double most = 0;
    for (const auto& share : levels.shares) most = std::max(most, share.drift_relative_sigma);
    return most;
  };
  EXPECT_GT(most_uncertain(early), 1.5 * most_uncertain(amid));
}

TEST_F(DriftStep, ItsUncertaintyEntersEveryReadingAndNotTheScale) {
  const auto steady = Reduce(*Record("steady", 0));
  const auto drifting = Reduce(*Record("drifting", 0.08));
  EXPECT_NEAR(drifting.series.scale_relative_sigma, steady.series.scale_relative_sigma,
              1e-3 * steady.series.scale_relative_sigma);
  const auto relative = [](const MeasuredLevels& levels) {
    const auto& brightest = levels.series.readings.back();
    return brightest.luminance_sigma / brightest.luminance;
  };
  EXPECT_GT(relative(drifting), relative(steady));
}

TEST_F(DriftStep, ASteadyDisplayIsLeftAlone) {
  const auto recording = Record("steady", 0);
  const auto measured = MeasureDrift(*recording);
  ASSERT_TRUE(measured.ok());
  EXPECT_EQ(measured->drift.order, 0);
  EXPECT_THAT(measured->warnings, IsEmpty());
  const auto levels = Reduce(*recording);
  EXPECT_THAT(levels.warnings, IsEmpty());
  EXPECT_THAT(levels.reference.reduced.luminance.image.history,
              Not(Contains(HasSubstr("CorrectDrift"))));
}

TEST_F(DriftStep, TooFewReferencesAreSaid) {
  const auto recording = Record("few", 0.08, 100);  // first and last alone
  const auto measured = MeasureDrift(*recording);
  ASSERT_TRUE(measured.ok()) << measured.status();
  EXPECT_EQ(measured->drift.order, 0);
  EXPECT_THAT(measured->warnings, Contains(HasSubstr("2 references")));
}

TEST_F(DriftStep, APhotodiodeSharpensWhatTheReferencesSay) {
  const auto alone = *MeasureDrift(*Record("alone", 0.08));
  const auto both = *MeasureDrift(*Record("both", 0.08, 2, Sees(0.08)));
  ASSERT_EQ(both.drift.order, 1);
  EXPECT_LT(both.drift.per_hour_sigma, 0.7 * alone.drift.per_hour_sigma);
  const double middle = 1 - 0.08 * both.drift.middle_s;
  EXPECT_NEAR(both.drift.per_hour, -0.08 * 3600 / middle, 4 * both.drift.per_hour_sigma);
  EXPECT_THAT(both.warnings,
              ElementsAre(HasSubstr("seen by the reference patch and the photodiode")));
}

TEST_F(DriftStep, APhotodiodeAloneSeesItOnWhateverIsShownTwice) {
  const auto recording = Record("without references", 0.08, 0, Sees(0.08));
  const auto measured = *MeasureDrift(*recording);
  ASSERT_EQ(measured.drift.order, 1) << measured.drift.per_hour_sigma;
  const double middle = 1 - 0.08 * measured.drift.middle_s;
  EXPECT_NEAR(measured.drift.per_hour, -0.08 * 3600 / middle, 4 * measured.drift.per_hour_sigma);
  EXPECT_THAT(measured.warnings, ElementsAre(HasSubstr("seen by the photodiode")));
  const auto [low, high] = Ratios(Reduce(*recording), Reduce(*Record("steady", 0)));
  EXPECT_LT(high / low, 1.01);
}

TEST_F(DriftStep, APhotodiodeThatDriftsByItselfIsNotBelieved) {
  const auto alone = *MeasureDrift(*Record("alone", 0.08));
  const auto measured = *MeasureDrift(*Record("apart", 0.08, 2, Sees(0.02)));
  EXPECT_EQ(measured.drift.per_hour, alone.drift.per_hour);
  EXPECT_THAT(measured.warnings, Contains(AllOf(HasSubstr("one of the two instruments drifts"),
                                                HasSubstr("the camera's was taken"))));
}

TEST_F(DriftStep, ACaptureInWhichTheDisplayDimmedIsNamed) {
  int bright = 0;
  const auto dims = [&bright, sees = Sees(0)](const CaptureSpec& shown, int64_t now_ns) {
    static constexpr DriveRgb kWhite = {1, 1, 1};
    const bool dimmed = shown.stimulus.drive == kWhite && shown.exposure_s > 0.4;
    bright += dimmed ? 1 : 0;
    return sees(shown, now_ns) * (dimmed ? 0.93 : 1);
  };
  const auto measured = *MeasureDrift(*Record("dims", 0, 2, dims));
  ASSERT_GT(bright, 0);
  EXPECT_EQ(measured.drift.order, 0);
  EXPECT_THAT(measured.warnings, Contains(AllOf(HasSubstr("the photodiode saw -"),
                                                HasSubstr("in capture"), HasSubstr("settle"))));
}

TEST_F(DriftStep, ASteadyDisplayGetsNoWarningFromAPhotodiode) {
  const auto measured = *MeasureDrift(*Record("steady", 0, 2, Sees(0)));
  EXPECT_EQ(measured.drift.order, 0);
  EXPECT_THAT(measured.warnings, IsEmpty());
}

TEST_F(DriftStep, FlashesOutOfStepWithTheCapturesAreNoDrift) {
  const auto flashes = [sees = Sees(0.08)](const CaptureSpec& shown, int64_t now_ns) {
    return now_ns % 11'000'000 < 2'200'000 ? 5 * sees(shown, now_ns) : 0;
  };
  const auto alone = *MeasureDrift(*Record("alone", 0.08));
  const auto both = *MeasureDrift(*Record("both", 0.08, 2, flashes));
  EXPECT_EQ(both.drift.order, 1);
  EXPECT_NEAR(both.drift.per_hour, alone.drift.per_hour, 4 * both.drift.per_hour_sigma);
  EXPECT_THAT(both.warnings, ElementsAre(HasSubstr("seen by")));
}

TEST_F(DriftStep, APhotodiodeThatSeesNoLightIsNotUsed) {
  const auto blind = [](const CaptureSpec&, int64_t) { return 0.0; };
  const auto measured = *MeasureDrift(*Record("blind", 0, 0, blind));
  EXPECT_EQ(measured.drift.order, 0);
  EXPECT_THAT(measured.warnings, ElementsAre(HasSubstr("the same with light and without")));
}

TEST_F(DriftStep, AClippedPhotodiodeIsNotUsed) {
  const auto clipped = [](const CaptureSpec&, int64_t) { return 1e5; };
  const auto measured = *MeasureDrift(*Record("clipped", 0, 0, clipped));
  EXPECT_EQ(measured.drift.order, 0);
  EXPECT_THAT(measured.warnings,
              ElementsAre(AllOf(HasSubstr("by the photodiode"), HasSubstr("are clipped"))));
}

TEST_F(DriftStep, WithoutReferencesThereIsNothingToSay) {
  const auto measured = MeasureDrift(*Record("none", 0.08, 0));
  ASSERT_TRUE(measured.ok());
  EXPECT_EQ(measured->drift.order, 0);
  EXPECT_THAT(measured->warnings, IsEmpty());
}

}  // namespace
}  // namespace eyebox::service
