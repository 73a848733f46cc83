// What a run does about a headset that glows after, sleeps, dims or warms up.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "capture/camera/sim/sim_rig.h"
#include "capture/plan.h"
#include "capture/run.h"
#include "tests/support/memory_recording.h"
#include "tests/support/restless_display.h"

namespace eyebox::capture {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

class RestlessRun : public testing::Test {
 protected:
  void SetUp() override {
    parameters_.sensor.size = {.width_px = 16, .height_px = 12};
    const RigConfig config = {.name = "test", .camera_uri = "sim:rift-s-like", .seed = 4};
    auto rig = OpenSimRig(config, parameters_, &clock_);
    ASSERT_TRUE(rig.ok()) << rig.status();
    rig_ = *std::move(rig);
    plan_ = *MakeGreyPlan({.levels = 5,
                           .exposures_s = {0.01},
                           .repeats = 3,
                           .dark_repeats = 2,
                           .flat_repeats = 0,
                           .reference_every = 2});  // d R l l R l l R l R
    options_.published = [this](const CaptureFigures& figures) {
      figures_.push_back(figures);
      return absl::OkStatus();
    };
  }

  absl::StatusOr<RunReport> Run(DisplayFaultOf fault) {
    MakeRestless(rig_, clock_, parameters_.sensor.bias_dn, std::move(fault));
    return RunPlan(rig_, plan_, recording_, options_);
  }

  // Light left over from the patch before: its share falls with `tau_s`.
  static DisplayFault Afterglow(const DisplayMoment& moment, double share, double tau_s) {
    if (!moment.before.stimulus.drive) return {};
    const double before_dn = 3000 * std::pow((*moment.before.stimulus.drive)[0], 2.3);
    return {.glow_dn = share * before_dn *
                       std::exp(-static_cast<double>(moment.shown_for_ns) / 1e9 / tau_s)};
  }

  static bool IsReference(const CaptureSpec& spec) { return spec.role == CaptureRole::kReference; }

  SimParameters parameters_;
  ManualClock clock_{10, 1700000000000000000};
  Rig rig_;
  CapturePlan plan_;
  MemoryRecording recording_;
  RunOptions options_;
  std::vector<CaptureFigures> figures_;
};

TEST_F(RestlessRun, AQuietDisplayRaisesNoDoubt) {
  options_.settle = SettleOptions{};
  const auto report = Run([](const DisplayMoment&) { return DisplayFault{}; });
  ASSERT_TRUE(report.ok()) << report.status();
  EXPECT_EQ(report->captures, static_cast<int>(plan_.captures.size()));
  EXPECT_EQ(report->captures_taken_again, 0);
  EXPECT_THAT(report->remarks, IsEmpty());
  EXPECT_THAT(recording_.suspect_since(), IsEmpty());
  EXPECT_THAT(recording_.captures(), SizeIs(plan_.captures.size()));
}

TEST_F(RestlessRun, WaitsAfterEveryTransitionUntilTheAfterglowIsGone) {
  options_.settle = SettleOptions{.window_s = 0.05};
  const auto glow = [](const DisplayMoment& moment) { return Afterglow(moment, 0.1, 0.2); };
  const auto report = Run(glow);
  ASSERT_TRUE(report.ok()) << report.status();
  double longest_s = 0;
  CaptureSpec shown;  // a level may show what the reference before it did
  for (const CaptureFigures& figures : figures_) {
    const CaptureSpec before = std::exchange(shown, figures.reading.spec);
    const bool changed =
        shown.kind == FrameKind::kLight && before.stimulus.drive != shown.stimulus.drive;
    ASSERT_EQ(figures.settling.has_value(), changed);
    if (!changed) continue;
    EXPECT_TRUE(figures.settling->settled);
    longest_s = std::max(longest_s, figures.settling->seconds);
  }
  EXPECT_GT(longest_s, 0.5);
  for (const auto& capture : recording_.Published()) {
    EXPECT_THAT(capture->frames, SizeIs(static_cast<size_t>(capture->spec.repeats)))
        << "frames that were taken while the scene settled are not data";
  }
}

TEST_F(RestlessRun, TheExposuresOfABracketSettleOnce) {
  options_.settle = SettleOptions{};
  plan_ = *MakeGreyPlan(
      {.levels = 2, .exposures_s = {0.01, 0.02}, .dark_repeats = 1, .flat_repeats = 1});
  ASSERT_TRUE(Run([](const DisplayMoment&) { return DisplayFault{}; }).ok());
  std::vector<bool> settled;
  for (const CaptureFigures& figures : figures_) settled.push_back(figures.settling.has_value());
  // Darks never, flats and each level in the first exposure.
  EXPECT_THAT(settled, ElementsAre(false, false, true, false, true, false, true, false));
}

TEST_F(RestlessRun, ASceneThatNeverSettlesIsTakenWithARemark) {
  options_.settle = SettleOptions{.longest_s = 0.3, .window_s = 0.05};
  const auto report = Run([](const DisplayMoment& moment) {
    const double shown_s = static_cast<double>(moment.shown_for_ns) / 1e9;
    return DisplayFault{.factor = IsReference(moment.spec) ? 1 : 1 + 0.5 * shown_s};
  });
  ASSERT_TRUE(report.ok()) << report.status();
  EXPECT_EQ(report->captures, static_cast<int>(plan_.captures.size()));
  EXPECT_THAT(report->remarks, testing::Contains(HasSubstr("had not settled after 0.3")));
}

// Without settling, what a bright patch leaves makes the next dark one brighter than brighter ones.
TEST_F(RestlessRun, ADarkPatchThatGlowsIsTakenAgain) {
  plan_.captures.clear();
  for (const double drive : {0.3, 1.0, 0.1}) {
    CaptureSpec spec;
    spec.stimulus.drive = DriveRgb{drive, drive, drive};
    spec.exposure_s = 0.01;
    spec.repeats = 2;
    plan_.captures.push_back(spec);
  }
  const auto report =
      Run([](const DisplayMoment& moment) { return Afterglow(moment, 0.5, 0.015); });
  ASSERT_TRUE(report.ok()) << report.status();
  EXPECT_GE(report->implausible, 1);
  EXPECT_EQ(report->captures_taken_again, report->implausible);
  EXPECT_EQ(figures_.back().attempts, 1 + report->implausible);
  EXPECT_LT(figures_.back().reading.mean.mean_dn, figures_.front().reading.mean.mean_dn);
  EXPECT_THAT(recording_.Published(), SizeIs(3));
}

TEST_F(RestlessRun, ADarkPatchThatStaysTooBrightIsKeptAndSaid) {
  plan_.captures.clear();
  for (const double drive : {0.3, 0.1}) {
    CaptureSpec spec;
    spec.stimulus.drive = DriveRgb{drive, drive, drive};
    spec.exposure_s = 0.01;
    spec.repeats = 2;
    plan_.captures.push_back(spec);
  }
  options_.implausible_attempts = 2;
  const auto report = Run([](const DisplayMoment& moment) {
    return DisplayFault{.glow_dn = (*moment.spec.stimulus.drive)[0] < 0.2 ? 500.0 : 0.0};
  });
  ASSERT_TRUE(report.ok()) << report.status();
  EXPECT_EQ(report->implausible, 2);
  EXPECT_THAT(report->remarks,
              ElementsAre(AllOf(HasSubstr("capture 2"), HasSubstr("drive (0.1, 0.1, 0.1)"),
                                HasSubstr("more than capture 1"))));
  EXPECT_THAT(recording_.Published(), SizeIs(2));
}

TEST_F(RestlessRun, AnEarlierPatchThatMustHaveBeenTooBrightIsNamed) {
  plan_.captures.clear();
  for (const double drive : {0.1, 0.3}) {
    CaptureSpec spec;
    spec.stimulus.drive = DriveRgb{drive, drive, drive};
    spec.exposure_s = 0.01;
    spec.repeats = 2;
    plan_.captures.push_back(spec);
  }
  const auto report = Run([](const DisplayMoment& moment) {
    return DisplayFault{.glow_dn = (*moment.spec.stimulus.drive)[0] < 0.2 ? 500.0 : 0.0};
  });
  ASSERT_TRUE(report.ok()) << report.status();
  EXPECT_THAT(report->remarks,
              ElementsAre(AllOf(HasSubstr("capture 2: "), HasSubstr("less than capture 1"))));
}

// Captures: 1 dark, 2 reference, 3 4 levels, 5 reference, 6 7 levels, 8 reference, 9 level, 10 ref.
TEST_F(RestlessRun, AHeadsetThatSleepsEndsTheRunAndNamesWhatIsSuspect) {
  const auto report = Run([](const DisplayMoment& moment) {
    return DisplayFault{.factor = moment.lights_presented > 5 ? 0.0 : 1.0};  // from capture 7 on
  });
  EXPECT_TRUE(absl::IsUnavailable(report.status())) << report.status();
  EXPECT_THAT(std::string(report.status().message()),
              AllOf(HasSubstr("capture 8"), HasSubstr("slept or dimmed"),
                    HasSubstr("from capture 6 on is marked suspect"), HasSubstr("resume")));
  EXPECT_THAT(recording_.suspect_since(), ElementsAre(6));
  EXPECT_THAT(recording_.Published(), SizeIs(8)) << "what was taken stays for inspection";
}

TEST_F(RestlessRun, AHeadsetThatDimsALittleIsTakenForDriftOnlyBelowTheLimit) {
  const auto dim_by = [](double share) {
    return [share](const DisplayMoment& moment) {
      return DisplayFault{.factor = moment.lights_presented > 5 ? 1 - share : 1};
    };
  };
  const auto report = Run(dim_by(0.3));
  EXPECT_TRUE(absl::IsUnavailable(report.status()));
  EXPECT_THAT(std::string(report.status().message()), HasSubstr("lost 30."));
  SetUp();
  EXPECT_TRUE(Run(dim_by(0.05)).ok());
}

TEST_F(RestlessRun, AReferenceThatBlinksOnceIsTakenAgain) {
  int references = 0;
  const auto report = Run([&references](const DisplayMoment& moment) {
    if (!IsReference(moment.spec)) return DisplayFault{};
    ++references;  // frames of references: 4 each
    return DisplayFault{.factor = references > 4 && references <= 8 ? 0.5 : 1.0};
  });
  ASSERT_TRUE(report.ok()) << report.status();
  EXPECT_EQ(report->implausible, 1);
  EXPECT_THAT(recording_.suspect_since(), IsEmpty());
}

TEST_F(RestlessRun, AHeadsetThatIsOffFromTheStartIsNoticedAtTheFirstReference) {
  const auto report = Run([](const DisplayMoment&) { return DisplayFault{.factor = 0}; });
  EXPECT_TRUE(absl::IsUnavailable(report.status()));
  EXPECT_THAT(std::string(report.status().message()), HasSubstr("as little as the dark"));
  EXPECT_THAT(recording_.suspect_since(), ElementsAre(1));
}

TEST_F(RestlessRun, WarmingUpSlowlyIsNoSleep) {
  const auto report = Run([](const DisplayMoment& moment) {
    return DisplayFault{.factor = 1 - 0.05 * moment.lights_presented / 9.0};
  });
  ASSERT_TRUE(report.ok()) << report.status();
  EXPECT_THAT(report->remarks, IsEmpty());
}

TEST_F(RestlessRun, ReadingsOfAnEarlierSessionCount) {
  CaptureSpec reference;
  for (const CaptureSpec& spec : plan_.captures) {
    if (IsReference(spec)) reference = spec;
  }
  options_.earlier = {{.number = 40, .spec = reference, .mean = {2000, 1}}};
  const auto report = Run([](const DisplayMoment&) { return DisplayFault{}; });
  EXPECT_TRUE(absl::IsUnavailable(report.status()));
  EXPECT_THAT(std::string(report.status().message()), HasSubstr("since capture 40"));
}

TEST_F(RestlessRun, FiguresTellWhatWasRead) {
  ASSERT_TRUE(Run([](const DisplayMoment&) { return DisplayFault{}; }).ok());
  ASSERT_THAT(figures_, SizeIs(plan_.captures.size()));
  std::map<double, double> means;
  for (size_t i = 0; i < figures_.size(); ++i) {
    const Reading& reading = figures_[i].reading;
    EXPECT_EQ(reading.number, static_cast<int>(i) + 1);
    EXPECT_EQ(reading.spec, plan_.captures[i]);
    EXPECT_EQ(figures_[i].attempts, 1);
    EXPECT_GT(reading.mean.sigma_dn, 0);
    if (reading.spec.kind == FrameKind::kDark) {
      EXPECT_NEAR(reading.mean.mean_dn, parameters_.sensor.bias_dn, 1);
    } else {
      means[(*reading.spec.stimulus.drive)[0]] = reading.mean.mean_dn;
    }
  }
  double before = 0;
  for (const auto& [drive, mean] : means) EXPECT_GT(mean, std::exchange(before, mean));
}

TEST_F(RestlessRun, AnErrorOfTheListenerEndsTheRun) {
  options_.published = [](const CaptureFigures&) { return absl::ResourceExhaustedError("full"); };
  const auto report = Run([](const DisplayMoment&) { return DisplayFault{}; });
  EXPECT_TRUE(absl::IsResourceExhausted(report.status()));
  EXPECT_THAT(recording_.Published(), SizeIs(1));
}

}  // namespace
}  // namespace eyebox::capture
