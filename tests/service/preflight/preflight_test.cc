// The simulated rig has exactly one fault, and the preflight names that one and no other.
#include "service/preflight/preflight.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <string>
#include <vector>

#include "capture/camera/sim/faults.h"
#include "tests/service/preflight/preflight_bench.h"

namespace eyebox::service {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

// Multiples of 1 / 90 s, the period of the strobe that the simulator's faults have.
const std::vector<double> kWholePeriods = {1.0 / 90, 4.0 / 90, 32.0 / 90};
constexpr capture::StrobeLight kStrobe90Hz = {.period_s = 1.0 / 90, .duty = 0.2};

PreflightBench With(const std::string& fault) {
  PreflightBench bench;
  const auto faults = capture::ParseFaults("fault=" + fault);
  EXPECT_TRUE(faults.ok()) << faults.status();
  bench.parameters.faults = *faults;
  return bench;
}

std::string Told(const std::vector<Check>& checks) {
  std::string told;
  for (const Check& check : checks) told += check.name + ": " + check.cause + "\n";
  return told;
}

// Seeds are part of the claim: it holds whatever the noise.
void ExpectOnly(PreflightBench bench, const std::string& name, const std::string& cause) {
  for (uint64_t seed = 1; seed <= 3; ++seed) {
    bench.seed = seed;
    const std::vector<Check> checks = bench.Run();
    EXPECT_THAT(NamesWith(checks, Verdict::kFailed), ElementsAre(name)) << "seed " << seed << "\n"
                                                                        << Told(checks);
    EXPECT_THAT(Named(checks, name).cause, HasSubstr(cause)) << "seed " << seed;
    EXPECT_THAT(Named(checks, name).remedy, Not(IsEmpty()));
  }
}

TEST(Preflight, NamesAutomaticExposure) {
  ExpectOnly(With("auto-exposure"), "exposure_ladder", "automatic exposure");
}

TEST(Preflight, NamesGamma) { ExpectOnly(With("gamma"), "exposure_ladder", "gamma"); }

TEST(Preflight, NamesStaleFramesAndHowMany) {
  ExpectOnly(With("stale-frames"), "stale_frames", "the first 2 after a change");
  PreflightBench bench;
  bench.parameters.faults.stale_frames = 1;
  ExpectOnly(bench, "stale_frames", "the first 1 after");
}

TEST(Preflight, NamesClampedBlack) {
  ExpectOnly(With("clamped-black"), "black_level", "stand at 0");
}

TEST(Preflight, NamesABlackLevelThatIsClampedAboveZero) {
  PreflightBench bench;
  bench.parameters.sensor.bias_dn = 0;  // the sensor clips at 0 by itself
  ExpectOnly(bench, "black_level", "clamped");
}

TEST(Preflight, NamesExposuresThatAreNoMultipleOfTheStrobe) {
  PreflightBench bench = With("strobe");
  bench.light = kStrobe90Hz;
  ExpectOnly(bench, "whole_periods", "0.0125 s is 1.125 refresh periods");
}

TEST(Preflight, IsContentWithAStrobeWhoseWholePeriodsAreUsed) {
  PreflightBench bench = With("strobe");
  bench.light = kStrobe90Hz;
  bench.exposures_s = kWholePeriods;
  const std::vector<Check> checks = bench.Run();
  EXPECT_THAT(NamesWith(checks, Verdict::kFailed), IsEmpty()) << Told(checks);
  EXPECT_THAT(NamesWith(checks, Verdict::kSkipped), IsEmpty());
  const Check& refresh = Named(checks, "refresh");
  EXPECT_NEAR(refresh.measured->value, 1.0 / 90, 4 * refresh.measured->sigma);
  EXPECT_NEAR(FigureOf(refresh, "duty"), 0.2, 0.02);
}

TEST(Preflight, NamesARollingShutterBeforeAStrobe) {
  PreflightBench bench = With("rolling-shutter");
  bench.light = kStrobe90Hz;
  bench.exposures_s = kWholePeriods;
  ExpectOnly(bench, "rolling_shutter", "rolling shutter");
  // 1 / 90 s of rows that follow each other after 0.3 ms.
  EXPECT_NEAR(FigureOf(Named(bench.Run(), "rolling_shutter"), "band_period"), 37, 6);
}

TEST(Preflight, NamesMoire) {
  ExpectOnly(With("moire"), "moire", "beat");
  // 1 / (1 / 0.93 - 1)
  EXPECT_NEAR(FigureOf(Named(With("moire").Run(), "moire"), "moire_period"), 13.3, 0.7);
}

TEST(Preflight, NamesASettingThatReadsBackOtherwise) {
  ExpectOnly(With("stuck-gain"), "read_back", "gain_db was set to 0 and reads back 6");
}

TEST(Preflight, WithoutPhotodiodeNamesTheUnsteadyLightOfAStrobe) {
  const std::vector<Check> checks = With("strobe").Run();
  EXPECT_THAT(Named(checks, "exposure_ladder").cause, HasSubstr("not steady"));
  EXPECT_THAT(Named(checks, "exposure_ladder").remedy, HasSubstr("photodiode"));
}

// 24 clean rigs, 192 checks. The spectral checks have a false-alarm probability of 1e-4 each, the
// others work beyond 3 sigma plus an allowance: one alarm among these is expected in 100 of such
// tests.
TEST(Preflight, PassesCleanRigs) {
  for (const char* name : {"rift-s-like", "ideal"}) {
    PreflightBench bench = {.parameters = *capture::NamedSimParameters(name)};
    for (bench.seed = 100; bench.seed < 112; ++bench.seed) {
      const std::vector<Check> checks = bench.Run();
      EXPECT_THAT(NamesWith(checks, Verdict::kFailed), IsEmpty())
          << name << ", seed " << bench.seed << "\n"
          << Told(checks);
      EXPECT_THAT(NamesWith(checks, Verdict::kSkipped), ElementsAre("refresh", "whole_periods"));
    }
  }
}

TEST(Preflight, OfASteadyDisplayTakesAnyExposure) {
  PreflightBench bench;
  bench.light = capture::StrobeLight{.period_s = 0.01, .duty = 1};
  const std::vector<Check> checks = bench.Run();
  EXPECT_THAT(NamesWith(checks, Verdict::kPassed).size(), 8) << Told(checks);
}

TEST(Preflight, SaysWhatToConnectWhereItSkips) {
  const std::vector<Check> checks = PreflightBench().Run();
  EXPECT_THAT(Named(checks, "refresh").remedy, HasSubstr("connect a photodiode"));
  EXPECT_THAT(Named(checks, "whole_periods").cause, HasSubstr("1/n"));
}

TEST(Preflight, FailsWhereEverythingIsSaturatedOrDark) {
  PreflightBench bright;
  bright.parameters.display.minimum_luminance_cd_m2 = 1e5;
  bright.parameters.sensor.exposure_min_s = 0.01;
  EXPECT_THAT(Named(bright.Run(), "exposure_ladder").cause,
              HasSubstr("every exposure is saturated"));
  PreflightBench dark;
  dark.parameters.sensor.responsivity_e_s_per_cd_m2 = 1e-6;
  EXPECT_THAT(Named(dark.Run(), "exposure_ladder").cause, HasSubstr("no exposure is brighter"));
}

TEST(Preflight, RefusesAnExposureOutsideTheLimitsBeforeAnyLight) {
  const TickingClock clock;
  auto rig = capture::OpenSimRig({.name = "t", .camera_uri = "sim:t"}, {}, &clock);
  ASSERT_TRUE(rig.ok());
  const auto checks = RunPreflight(*rig, nullptr, {.exposures_s = {0.01, 1e4}}, {});
  EXPECT_TRUE(absl::IsInvalidArgument(checks.status())) << checks.status();
  EXPECT_THAT(std::string(checks.status().message()), HasSubstr("exposure"));
  EXPECT_TRUE(absl::IsInvalidArgument(RunPreflight(*rig, nullptr, {.frames = 1}, {}).status()));
}

TEST(Preflight, StopsWhenCancelled) {
  const TickingClock clock;
  auto rig = capture::OpenSimRig({.name = "t", .camera_uri = "sim:t"}, {}, &clock);
  ASSERT_TRUE(rig.ok());
  const Watcher watcher = {.progress = {}, .cancelled = [] { return true; }};
  EXPECT_TRUE(absl::IsCancelled(RunPreflight(*rig, nullptr, {}, watcher).status()));
}

}  // namespace
}  // namespace eyebox::service
