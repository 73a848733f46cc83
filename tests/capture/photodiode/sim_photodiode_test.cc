#include "capture/photodiode/sim/sim_photodiode.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace eyebox::capture {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class SimPhotodiodeTest : public testing::Test {
 protected:
  std::unique_ptr<Photodiode> Started(const SimPhotodiodeParameters& parameters,
                                      uint64_t seed = 3) {
    auto photodiode = MakeSimPhotodiode({.uri = "sim:test", .seed = seed}, parameters, &clock_);
    EXPECT_TRUE(photodiode.ok()) << photodiode.status();
    EXPECT_TRUE((*photodiode)->Configure({.sample_rate_hz = 1000}).ok());
    EXPECT_TRUE((*photodiode)->Start().ok());
    return *std::move(photodiode);
  }

  ManualClock clock_{1'000'000};
};

TEST_F(SimPhotodiodeTest, GivesWhatIsDueAndNoMore) {
  const auto photodiode = Started({.noise_counts = 0});
  clock_.AdvanceNs(2'500'000);
  const auto block = photodiode->Read({});
  ASSERT_TRUE(block.ok()) << block.status();
  EXPECT_EQ(block->sequence, 0);
  EXPECT_EQ(block->lost_before, 0);
  // Lit for the first 0.2 of 11.1 ms.
  EXPECT_THAT(block->samples,
              ElementsAre(PhotodiodeSample{1'000'000, 620}, PhotodiodeSample{2'000'000, 620},
                          PhotodiodeSample{3'000'000, 620}));
  EXPECT_TRUE(absl::IsDeadlineExceeded(photodiode->Read({}).status()));
}

TEST_F(SimPhotodiodeTest, CountsDoNotDependOnHowTheyAreRead) {
  const auto at_once = Started({});
  clock_.AdvanceNs(50'000'000);
  const auto all = at_once->Read({});
  ASSERT_TRUE(all.ok());
  const auto in_pieces = Started({});
  std::vector<int32_t> counts;
  for (int i = 0; i < 51; ++i) {
    const auto block = in_pieces->Read({});
    ASSERT_TRUE(block.ok());
    for (const auto& sample : block->samples) counts.push_back(sample.counts);
    clock_.AdvanceNs(1'000'000);
  }
  ASSERT_EQ(counts.size(), all->samples.size());
  for (size_t i = 0; i < counts.size(); ++i) EXPECT_EQ(counts[i], all->samples[i].counts);
}

TEST_F(SimPhotodiodeTest, OtherSeedsGiveOtherNoise) {
  const auto first = Started({}, 1);
  const auto second = Started({}, 2);
  clock_.AdvanceNs(20'000'000);
  EXPECT_NE(first->Read({})->samples, second->Read({})->samples);
}

TEST_F(SimPhotodiodeTest, LostConversionsAreCounted) {
  const auto photodiode = Started({.lost_share = 0.2});
  clock_.AdvanceNs(2'000'000'000);
  uint64_t next = 0;
  uint64_t lost = 0;
  for (auto block = photodiode->Read({}); block.ok(); block = photodiode->Read({})) {
    EXPECT_EQ(block->sequence, next + block->lost_before);
    EXPECT_EQ(block->samples.front().monotonic_ns,
              1'000'000 + static_cast<int64_t>(block->sequence) * 1'000'000);
    lost += block->lost_before;
    next = block->sequence + block->samples.size();
  }
  EXPECT_NEAR(static_cast<double>(lost), 400, 80);
}

TEST_F(SimPhotodiodeTest, CallsOutOfOrderAreRefused) {
  auto photodiode = MakeSimPhotodiode({.uri = "sim:test"}, {}, &clock_);
  ASSERT_TRUE(photodiode.ok());
  EXPECT_TRUE(absl::IsFailedPrecondition((*photodiode)->Start()));
  EXPECT_TRUE(absl::IsFailedPrecondition((*photodiode)->Read({}).status()));
  EXPECT_TRUE((*photodiode)->Stop().ok());
  ASSERT_TRUE((*photodiode)->Configure({}).ok());
  ASSERT_TRUE((*photodiode)->Start().ok());
  EXPECT_TRUE(absl::IsFailedPrecondition((*photodiode)->Start()));
  EXPECT_TRUE(absl::IsFailedPrecondition((*photodiode)->Configure({}).status()));
}

TEST_F(SimPhotodiodeTest, RatesOutsideItsLimitsAreRefused) {
  auto photodiode = MakeSimPhotodiode({.uri = "sim:test"}, {}, &clock_);
  ASSERT_TRUE(photodiode.ok());
  for (const double rate_hz : {0.0, -1.0, 1e9, std::nan("")}) {
    const auto set = (*photodiode)->Configure({.sample_rate_hz = rate_hz});
    EXPECT_TRUE(absl::IsInvalidArgument(set.status())) << rate_hz;
  }
  EXPECT_TRUE(absl::IsInvalidArgument((*photodiode)->Configure({.pulse_started = true}).status()));
}

TEST(SimPhotodiodeParameters, NamesTheFieldThatIsWrong) {
  const SimPhotodiodeParameters parameters = {.noise_counts = std::nan("")};
  EXPECT_THAT(parameters.Validate().message(), HasSubstr("noise_counts"));
}

TEST(StrobeLight, IntegralIsThatOfItsValues) {
  const StrobeLight light = {.period_s = 0.01, .duty = 0.3, .phase_s = 0.004};
  for (const double begin_s : {-0.013, 0.0, 0.0052}) {
    const double end_s = begin_s + 0.0277;
    double sum_s = 0;
    constexpr int kSteps = 200000;
    for (int i = 0; i < kSteps; ++i) {
      sum_s += light.At(begin_s + 0.0277 * (i + 0.5) / kSteps) * 0.0277 / kSteps;
    }
    EXPECT_NEAR(light.IntegralS(begin_s, end_s), sum_s, 1e-6);
  }
}

TEST(PhotodiodeUri, ChoosesByScheme) {
  const ManualClock clock;
  for (const std::string& name : SimPhotodiodeNames()) {
    const auto photodiode = OpenPhotodiode({.uri = "sim:" + name}, &clock);
    ASSERT_TRUE(photodiode.ok()) << photodiode.status();
    EXPECT_EQ((*photodiode)->Info().uri, "sim:" + name);
  }
  EXPECT_THAT(PhotodiodeSchemes(), ElementsAre("iio", "serial", "sim", "replay"));
}

TEST(PhotodiodeUri, UnknownOnesListTheKnown) {
  const ManualClock clock;
  EXPECT_THAT(OpenPhotodiode({.uri = "usb:1"}, &clock).status().message(),
              HasSubstr("iio: serial: sim: replay:"));
  EXPECT_THAT(OpenPhotodiode({.uri = "sim:moon"}, &clock).status().message(),
              HasSubstr("strobe-90hz"));
  EXPECT_TRUE(absl::IsNotFound(OpenPhotodiode({.uri = "serial:/dev/tty-none"}, &clock).status()));
  for (const char* const uri : {"serial:", "replay:", "iio:x", "iio:/y", "iio:x/", "iio:x/y?a=1"}) {
    EXPECT_TRUE(absl::IsInvalidArgument(OpenPhotodiode({.uri = uri}, &clock).status())) << uri;
  }
}

}  // namespace
}  // namespace eyebox::capture
