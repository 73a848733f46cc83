#include "capture/photodiode/strobe.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "capture/photodiode/sim/sim_photodiode.h"

namespace eyebox::capture {
namespace {

using testing::HasSubstr;

constexpr StrobeOptions kOptions = {.minimum_counts = 0, .maximum_counts = 1023};

// `seconds` of a simulated photodiode at `rate_hz`.
std::vector<PhotodiodeSample> Record(const SimPhotodiodeParameters& parameters, double rate_hz,
                                     double seconds, uint64_t seed = 1) {
  ManualClock clock(5'000'000'000);
  auto photodiode = MakeSimPhotodiode({.uri = "sim:test", .seed = seed}, parameters, &clock);
  EXPECT_TRUE(photodiode.ok()) << photodiode.status();
  EXPECT_TRUE((*photodiode)->Configure({.sample_rate_hz = rate_hz}).ok());
  EXPECT_TRUE((*photodiode)->Start().ok());
  clock.AdvanceNs(std::llround(seconds * 1e9));
  std::vector<PhotodiodeSample> samples;
  for (auto block = (*photodiode)->Read({}); block.ok(); block = (*photodiode)->Read({})) {
    samples.insert(samples.end(), block->samples.begin(), block->samples.end());
  }
  return samples;
}

void ExpectTruth(const StrobeMeasurement& measured, const StrobeLight& light) {
  EXPECT_TRUE(measured.strobed);
  EXPECT_LE(std::abs(measured.period_s - light.period_s), 4 * measured.period_sigma_s);
  EXPECT_LT(measured.period_sigma_s, 3e-4 * light.period_s);
  EXPECT_LE(std::abs(measured.duty - light.duty), 4 * measured.duty_sigma);
}

TEST(Strobe, PeriodAndDutyAreTrueWithinTheirSigma) {
  for (const double hz : {59.94, 72.0, 80.0, 90.0, 119.88, 240.0}) {
    for (const double duty : {0.08, 0.2, 0.5, 0.85}) {
      SimPhotodiodeParameters parameters;
      parameters.light = {.period_s = 1 / hz, .duty = duty, .phase_s = 0.0031};
      const auto measured = MeasureStrobe(Record(parameters, 4133, 1.5), kOptions);
      ASSERT_TRUE(measured.ok()) << measured.status() << " " << hz << " " << duty;
      SCOPED_TRACE(testing::Message() << hz << " Hz, duty " << duty);
      ExpectTruth(*measured, parameters.light);
      EXPECT_LT(measured->duty_sigma, 0.02);
      EXPECT_NEAR(measured->high_counts, 620, 12);
      EXPECT_NEAR(measured->low_counts, 20, 12);
    }
  }
}

// 95 % intervals must hold in about 95 % of trials; of 60, fewer than 50 happens once in 10^4.
TEST(Strobe, SigmaOfThePeriodIsHonestUnderNoise) {
  SimPhotodiodeParameters parameters;
  parameters.light = {.period_s = 1.0 / 90, .duty = 0.2};
  parameters.noise_counts = 120;
  parameters.dark_counts = 1000;
  parameters.bits = 12;
  int inside = 0;
  for (uint64_t seed = 0; seed < 60; ++seed) {
    const auto measured = MeasureStrobe(Record(parameters, 2000, 0.5, seed),
                                        {.frequency_max_hz = 300, .maximum_counts = 4095});
    ASSERT_TRUE(measured.ok()) << measured.status();
    ASSERT_TRUE(measured->strobed);
    inside += std::abs(measured->period_s - 1.0 / 90) < 1.96 * measured->period_sigma_s ? 1 : 0;
    EXPECT_NEAR(measured->duty, 0.2, 0.04);
  }
  EXPECT_GE(inside, 50);
}

TEST(Strobe, JitterDriftLossesAndALowPassDoNotMislead) {
  SimPhotodiodeParameters parameters;
  parameters.light = {.period_s = 1.0 / 72, .duty = 0.15, .phase_s = 0.002};
  parameters.time_jitter_s = 20e-6;
  parameters.drift_per_s = 0.02;
  parameters.lost_share = 0.03;
  parameters.settling_s = 150e-6;
  const auto measured = MeasureStrobe(Record(parameters, 3000, 2), kOptions);
  ASSERT_TRUE(measured.ok()) << measured.status();
  EXPECT_LE(std::abs(measured->period_s - 1.0 / 72), 4 * measured->period_sigma_s);
  EXPECT_NEAR(measured->duty, 0.15, 0.02);
}

// 25 samples a period: the phases sampled are 25 and no more, which the sigma must say.
TEST(Strobe, SamplingThatKeepsStepWithTheStrobeIsKnownToBeBlindBetween) {
  SimPhotodiodeParameters parameters;
  parameters.light = {.period_s = 1.0 / 80, .duty = 0.21};
  const auto measured = MeasureStrobe(Record(parameters, 2000, 2), kOptions);
  ASSERT_TRUE(measured.ok()) << measured.status();
  ExpectTruth(*measured, parameters.light);
  EXPECT_GT(measured->duty_sigma, 0.04 / std::sqrt(6.0) / 2);
}

TEST(Strobe, AlternatingFlashesCountAsOneLongPeriod) {
  SimPhotodiodeParameters parameters;
  parameters.light = {.period_s = 1.0 / 90, .duty = 0.2};
  auto samples = Record(parameters, 4133, 1.5);
  for (PhotodiodeSample& sample : samples) {
    const double periods = static_cast<double>(sample.monotonic_ns - 5'000'000'000) * 90e-9;
    if (static_cast<int64_t>(periods) % 2 == 1) sample.counts -= (sample.counts - 20) / 5;
  }
  const auto measured = MeasureStrobe(samples, kOptions);
  ASSERT_TRUE(measured.ok()) << measured.status();
  EXPECT_NEAR(measured->period_s, 2.0 / 90, 1e-5);
}

TEST(Strobe, ASteadyDisplayIsNotStrobed) {
  SimPhotodiodeParameters parameters;
  parameters.light.duty = 1;
  parameters.drift_per_s = 0.01;
  for (uint64_t seed = 0; seed < 20; ++seed) {
    const auto measured = MeasureStrobe(Record(parameters, 2000, 1, seed), kOptions);
    ASSERT_TRUE(measured.ok()) << measured.status();
    EXPECT_FALSE(measured->strobed);
    EXPECT_EQ(measured->duty, 1);
    EXPECT_NEAR(measured->high_counts, 623, 2);
  }
}

TEST(Strobe, FasterThanAQuarterOfTheSampleRateIsRefused) {
  SimPhotodiodeParameters parameters;
  parameters.light = {.period_s = 1.0 / 240, .duty = 0.5};
  const auto measured = MeasureStrobe(Record(parameters, 700, 2), kOptions);
  EXPECT_TRUE(absl::IsFailedPrecondition(measured.status()));
  EXPECT_THAT(measured.status().message(), HasSubstr("too slowly to exclude an alias"));
}

TEST(Strobe, AnAliasMovesWithTheSampleRateAndIsRefused) {
  SimPhotodiodeParameters parameters;
  parameters.light = {.period_s = 1.0 / 1090, .duty = 0.5};  // PWM, seen as 90 Hz at 1000 Hz
  const auto first = MeasureStrobe(Record(parameters, 1000, 2), kOptions);
  const auto second = MeasureStrobe(Record(parameters, 940, 2), kOptions);
  ASSERT_TRUE(first.ok()) << first.status();
  ASSERT_TRUE(second.ok()) << second.status();
  EXPECT_NEAR(1 / first->period_s, 90, 0.1);
  const absl::Status checked = CheckNotAliased(*first, *second);
  EXPECT_TRUE(absl::IsFailedPrecondition(checked));
  EXPECT_THAT(checked.message(), HasSubstr("an alias"));
}

TEST(Strobe, ATruePeriodIsTheSameAtBothRates) {
  SimPhotodiodeParameters parameters;
  const auto first = MeasureStrobe(Record(parameters, 2000, 2, 1), kOptions);
  const auto second = MeasureStrobe(Record(parameters, 1870, 2, 2), kOptions);
  ASSERT_TRUE(first.ok() && second.ok()) << first.status() << second.status();
  EXPECT_TRUE(CheckNotAliased(*first, *second).ok());
  EXPECT_TRUE(absl::IsInvalidArgument(CheckNotAliased(*first, *first)));
  EXPECT_TRUE(absl::IsFailedPrecondition(CheckNotAliased(*first, StrobeMeasurement())));
}

TEST(Strobe, ClippedSamplesAreRefused) {
  SimPhotodiodeParameters parameters;
  parameters.level_counts = 1500;
  const auto measured = MeasureStrobe(Record(parameters, 2000, 1), kOptions);
  EXPECT_TRUE(absl::IsFailedPrecondition(measured.status()));
  EXPECT_THAT(measured.status().message(), HasSubstr("clipped at 1023"));
}

TEST(Strobe, TooFewPeriodsAreRefused) {
  const auto measured = MeasureStrobe(Record(SimPhotodiodeParameters(), 2000, 0.15), kOptions);
  EXPECT_TRUE(absl::IsFailedPrecondition(measured.status()));
  EXPECT_THAT(measured.status().message(), HasSubstr("periods"));
}

TEST(Strobe, TooFewOrDisorderedSamplesAreRefused) {
  std::vector<PhotodiodeSample> samples(20, {.monotonic_ns = 7, .counts = 5});
  EXPECT_TRUE(absl::IsInvalidArgument(MeasureStrobe(samples, kOptions).status()));
  EXPECT_TRUE(absl::IsInvalidArgument(MeasureStrobe({}, kOptions).status()));
}

TEST(Strobe, OptionsAreChecked) {
  EXPECT_TRUE(absl::IsInvalidArgument(StrobeOptions{.frequency_min_hz = 0}.Validate()));
  EXPECT_TRUE(absl::IsInvalidArgument(
      StrobeOptions{.frequency_min_hz = 50, .frequency_max_hz = 50}.Validate()));
  EXPECT_TRUE(absl::IsInvalidArgument(StrobeOptions{.minimum_samples_per_period = 2}.Validate()));
  EXPECT_TRUE(absl::IsInvalidArgument(StrobeOptions{.minimum_depth = std::nan("")}.Validate()));
}

}  // namespace
}  // namespace eyebox::capture
