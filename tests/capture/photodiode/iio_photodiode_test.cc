// The logic above the seam; libiio itself is tested against the kernel's iio_dummy
// (tests/hardware).
#include "capture/photodiode/iio/iio_photodiode.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <deque>
#include <filesystem>
#include <map>
#include <utility>

#include "capture/photodiode/iio/hrtimer_trigger.h"

namespace eyebox::capture {
namespace {

using iio::RawSample;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr int64_t kMs = 1'000'000;

// What the test can set and look at, shared with the device that the photodiode owns.
struct Bench {
  std::map<std::string, std::string> attributes = {{"current_timestamp_clock", "realtime\n"}};
  std::map<std::string, std::string> trigger_attributes = {{"sampling_frequency", "100\n"}};
  bool times_itself = false;
  bool sticky_clock = false;  // takes the clock and keeps its own
  std::deque<std::vector<RawSample>> batches;
  absl::Status end;  // after them
  bool buffer_open = false;
  size_t buffer_samples = 0;
};

class FakeIioDevice final : public iio::IioDevice {
 public:
  FakeIioDevice(Bench* bench, iio::ChannelFormat format) : bench_(bench), format_(format) {}

  std::string Name() const override { return "fake-adc"; }
  iio::ChannelFormat Format() const override { return format_; }
  bool TimesItself() const override { return bench_->times_itself; }
  absl::Status WriteAttribute(const std::string& name, const std::string& value) override {
    if (bench_->sticky_clock) return absl::OkStatus();
    return Write(bench_->attributes, name, value);
  }
  absl::StatusOr<std::string> ReadAttribute(const std::string& name) override {
    return ReadOf(bench_->attributes, name);
  }
  absl::Status WriteTriggerAttribute(const std::string& name, const std::string& value) override {
    return Write(bench_->trigger_attributes, name, value);
  }
  absl::StatusOr<std::string> ReadTriggerAttribute(const std::string& name) override {
    return ReadOf(bench_->trigger_attributes, name);
  }
  absl::Status OpenBuffer(size_t samples, size_t) override {
    bench_->buffer_open = true;
    bench_->buffer_samples = samples;
    return absl::OkStatus();
  }
  absl::StatusOr<std::vector<RawSample>> Refill(std::chrono::milliseconds) override {
    if (!bench_->batches.empty()) {
      std::vector<RawSample> batch = std::move(bench_->batches.front());
      bench_->batches.pop_front();
      return batch;
    }
    if (!bench_->end.ok()) return bench_->end;
    return std::vector<RawSample>();
  }
  void CloseBuffer() override { bench_->buffer_open = false; }

 private:
  using Attributes = std::map<std::string, std::string>;
  static absl::Status Write(Attributes& attributes, const std::string& name,
                            const std::string& value) {
    if (!attributes.contains(name)) return absl::NotFoundError(name);
    attributes[name] = value + "\n";
    return absl::OkStatus();
  }
  static absl::StatusOr<std::string> ReadOf(const Attributes& attributes, const std::string& name) {
    if (!attributes.contains(name)) return absl::NotFoundError(name);
    return attributes.at(name);
  }

  Bench* const bench_;
  const iio::ChannelFormat format_;
};

class IioPhotodiode : public testing::Test {
 protected:
  absl::StatusOr<std::unique_ptr<Photodiode>> Open(iio::ChannelFormat format = {12, false}) {
    return MakeIioPhotodiode("iio:fake-adc/voltage0",
                             std::make_unique<FakeIioDevice>(&bench_, format), &clock_);
  }

  std::unique_ptr<Photodiode> Started(const PhotodiodeSettings& settings) {
    auto photodiode = Open();
    EXPECT_TRUE(photodiode.ok()) << photodiode.status();
    EXPECT_TRUE((*photodiode)->Configure(settings).ok());
    EXPECT_TRUE((*photodiode)->Start().ok());
    return *std::move(photodiode);
  }

  Bench bench_;
  ManualClock clock_{1000 * kMs};
};

TEST_F(IioPhotodiode, SetsItsStampsToMonotonicTime) {
  ASSERT_TRUE(Open().ok());
  EXPECT_EQ(bench_.attributes["current_timestamp_clock"], "monotonic\n");
}

TEST_F(IioPhotodiode, AClockThatDoesNotReadBackIsRefused) {
  bench_.sticky_clock = true;
  const auto photodiode = Open();
  EXPECT_TRUE(absl::IsUnavailable(photodiode.status()));
  EXPECT_THAT(photodiode.status().message(), HasSubstr("'realtime'"));
}

TEST_F(IioPhotodiode, KnowsItsRails) {
  const auto plain = Open({12, false});
  EXPECT_EQ((*plain)->Info().minimum_counts, 0);
  EXPECT_EQ((*plain)->Info().maximum_counts, 4095);
  const auto with_sign = Open({16, true});
  EXPECT_EQ((*with_sign)->Info().minimum_counts, -32768);
  EXPECT_EQ((*with_sign)->Info().maximum_counts, 32767);
}

TEST_F(IioPhotodiode, SetsTheRateOfItsTriggerAndReadsItBack) {
  auto photodiode = Open();
  const auto set = (*photodiode)->Configure({.sample_rate_hz = 250});
  ASSERT_TRUE(set.ok()) << set.status();
  EXPECT_DOUBLE_EQ(set->sample_rate_hz, 250);
  EXPECT_THAT(bench_.trigger_attributes["sampling_frequency"], HasSubstr("250"));
}

TEST_F(IioPhotodiode, SetsItsOwnRateWhereItTimesItself) {
  bench_.trigger_attributes.clear();
  bench_.times_itself = true;
  bench_.attributes["sampling_frequency"] = "128\n";
  auto photodiode = Open();
  ASSERT_TRUE((*photodiode)->Configure({.sample_rate_hz = 490}).ok());
  EXPECT_THAT(bench_.attributes["sampling_frequency"], HasSubstr("490"));
}

TEST_F(IioPhotodiode, WithATriggerWithoutRateItCanOnlyBePulseStarted) {
  bench_.trigger_attributes.clear();
  bench_.attributes["sampling_frequency"] = "128\n";  // of single conversions, not of the trigger
  auto photodiode = Open();
  EXPECT_TRUE(absl::IsInvalidArgument((*photodiode)->Configure({}).status()));
  EXPECT_TRUE((*photodiode)->Configure({.pulse_started = true}).ok());
  ASSERT_TRUE((*photodiode)->Start().ok());
  EXPECT_EQ(bench_.buffer_samples, 1);
}

TEST_F(IioPhotodiode, AGapInTheStampsIsLostConversions) {
  const auto photodiode = Started({.sample_rate_hz = 1000});
  bench_.batches.push_back(
      std::vector<RawSample>{{10 * kMs, 5}, {11 * kMs, 6}, {14 * kMs + 20000, 7}, {15 * kMs, 8}});
  const auto first = photodiode->Read({});
  ASSERT_TRUE(first.ok()) << first.status();
  EXPECT_THAT(first->samples,
              ElementsAre(PhotodiodeSample{10 * kMs, 5}, PhotodiodeSample{11 * kMs, 6}));
  const auto second = photodiode->Read({});
  ASSERT_TRUE(second.ok());
  EXPECT_EQ(second->lost_before, 2);
  EXPECT_EQ(second->sequence, 4);
  EXPECT_EQ(second->samples.size(), 2);
}

TEST_F(IioPhotodiode, PulsesMayComeAtAnyTime) {
  const auto photodiode = Started({.pulse_started = true});
  bench_.batches.push_back({{10 * kMs, 5}, {700 * kMs, 6}});
  const auto block = photodiode->Read({});
  ASSERT_TRUE(block.ok());
  EXPECT_EQ(block->samples.size(), 2);
  clock_.AdvanceNs(100'000 * kMs);
  EXPECT_TRUE(absl::IsDeadlineExceeded(photodiode->Read({}).status()));
}

TEST_F(IioPhotodiode, ATimedConverterThatFallsSilentIsLost) {
  const auto photodiode = Started({.sample_rate_hz = 1000});
  EXPECT_TRUE(absl::IsDeadlineExceeded(photodiode->Read({}).status()));
  clock_.AdvanceNs(1500 * kMs);
  EXPECT_TRUE(absl::IsUnavailable(photodiode->Read({}).status()));
}

TEST_F(IioPhotodiode, UnpluggedIsPassedOn) {
  const auto photodiode = Started({.sample_rate_hz = 1000});
  bench_.end = absl::UnavailableError("No such device");
  EXPECT_TRUE(absl::IsUnavailable(photodiode->Read({}).status()));
}

TEST_F(IioPhotodiode, StampsOfAnotherClockAreRefused) {
  const auto photodiode = Started({.sample_rate_hz = 1000});
  bench_.batches.push_back({{1'700'000'000'000 * kMs, 5}});
  EXPECT_THAT(photodiode->Read({}).status().message(), HasSubstr("not CLOCK_MONOTONIC"));
}

TEST_F(IioPhotodiode, StampsThatStandStillAreRefused) {
  const auto photodiode = Started({.sample_rate_hz = 1000});
  bench_.batches.push_back({{10 * kMs, 5}, {10 * kMs, 6}});
  EXPECT_THAT(photodiode->Read({}).status().message(), HasSubstr("do not ascend"));
}

TEST_F(IioPhotodiode, StopClosesTheBuffer) {
  const auto photodiode = Started({.sample_rate_hz = 1000});
  EXPECT_TRUE(bench_.buffer_open);
  ASSERT_TRUE(photodiode->Stop().ok());
  EXPECT_FALSE(bench_.buffer_open);
}

TEST(IioUri, NamesDeviceChannelAndTrigger) {
  const auto address = iio::ParseIioUri("iio:iio:device0/voltage0?trigger=t0");
  ASSERT_TRUE(address.ok()) << address.status();
  EXPECT_EQ(address->device, "iio:device0");
  EXPECT_EQ(address->channel, "voltage0");
  EXPECT_EQ(address->trigger, "t0");
}

TEST(HrtimerTrigger, IsMadeOnce) {
  const auto folder = std::filesystem::path(testing::TempDir()) / "hrtimer_trigger_test";
  std::filesystem::create_directories(folder);
  EXPECT_TRUE(iio::EnsureHrtimerTrigger("eyebox", folder).ok());
  EXPECT_TRUE(iio::EnsureHrtimerTrigger("eyebox", folder).ok());
  EXPECT_TRUE(std::filesystem::is_directory(folder / "eyebox"));
  std::filesystem::remove_all(folder);
}

TEST(HrtimerTrigger, WithoutConfigfsItSaysWhatToDo) {
  const absl::Status made = iio::EnsureHrtimerTrigger("eyebox", "/nowhere/iio");
  EXPECT_TRUE(absl::IsUnavailable(made));
  EXPECT_THAT(made.message(), HasSubstr("iio-trig-hrtimer"));
}

}  // namespace
}  // namespace eyebox::capture
