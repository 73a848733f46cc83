// The libiio backend against the kernel's iio_dummy. Run by tests/hardware/run in the guest; it is
// skipped where there is no iio_dummy.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <thread>

#include "capture/photodiode/photodiode.h"
#include "capture/trigger/match_edges.h"
#include "capture/trigger/trigger.h"
#include "tests/hardware/gpio_sim.h"

namespace eyebox::capture {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;
using testing::HasSubstr;

constexpr auto kLong = milliseconds(20000);

class Iio : public testing::Test {
 protected:
  void SetUp() override {
    if (!fs::is_directory("/sys/kernel/config/iio/devices/dummy")) {
      GTEST_SKIP() << "no iio_dummy here: run tests/hardware/run";
    }
    ASSERT_TRUE(fs::create_directory(device_));
  }
  void TearDown() override {
    if (fs::exists(device_)) fs::remove(device_);
  }

  static absl::StatusOr<std::unique_ptr<Photodiode>> Open(const std::string& rest) {
    return OpenPhotodiode({.uri = "iio:eyebox_adc/" + rest}, SystemClock());
  }

  const fs::path device_ = "/sys/kernel/config/iio/devices/dummy/eyebox_adc";
};

TEST_F(Iio, ATimerThatItMakesStartsConversionsOnOurClock) {
  auto photodiode = Open("voltage0");
  ASSERT_TRUE(photodiode.ok()) << photodiode.status();
  const auto set = (*photodiode)->Configure({.sample_rate_hz = 100});
  ASSERT_TRUE(set.ok()) << set.status();
  EXPECT_DOUBLE_EQ(set->sample_rate_hz, 100);
  const int64_t started_ns = SystemClock()->MonotonicNs();
  ASSERT_TRUE((*photodiode)->Start().ok());
  size_t count = 0;
  int64_t last_ns = started_ns;
  while (count < 50) {
    const auto block = (*photodiode)->Read(kLong);
    ASSERT_TRUE(block.ok()) << block.status();
    for (const PhotodiodeSample& sample : block->samples) {
      EXPECT_GT(sample.monotonic_ns, last_ns);
      EXPECT_EQ(sample.counts, 7);  // iio_dummy's constant for voltage0
      last_ns = sample.monotonic_ns;
    }
    count += block->samples.size();
  }
  EXPECT_LE(last_ns, SystemClock()->MonotonicNs());
  EXPECT_TRUE((*photodiode)->Stop().ok());
}

TEST_F(Iio, StartsAgainAfterStop) {
  auto photodiode = Open("voltage0");
  ASSERT_TRUE(photodiode.ok()) << photodiode.status();
  ASSERT_TRUE((*photodiode)->Configure({.sample_rate_hz = 200}).ok());
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE((*photodiode)->Start().ok());
    EXPECT_TRUE((*photodiode)->Read(kLong).ok());
    ASSERT_TRUE((*photodiode)->Stop().ok());
  }
}

// Stands for the wire from our GPIO line to the trigger input of the converter: passes each rising
// edge on to the sysfs trigger.
class Wire {
 public:
  Wire(const GpioSim* sim, int line)
      : thread_([sim, line](const std::stop_token& stop) {
          const fs::path conversion = FindTrigger();
          for (std::string last = "0"; !stop.stop_requested();) {
            const std::string now = sim->Value(line);
            if (last == "0" && now == "1") std::ofstream(conversion) << 1;
            last = now;
          }
        }) {}

 private:
  static fs::path FindTrigger() {
    for (const auto& entry : fs::directory_iterator("/sys/bus/iio/devices")) {
      if (fs::exists(entry.path() / "trigger_now")) return entry.path() / "trigger_now";
    }
    return {};
  }

  std::jthread thread_;
};

class PulsedIio : public Iio {
 protected:
  void SetUp() override {
    if (!GpioSim::IsAvailable()) GTEST_SKIP() << "no gpio-sim here: run tests/hardware/run";
    Iio::SetUp();
    if (IsSkipped()) return;
    std::ofstream("/sys/bus/iio/devices/iio_sysfs_trigger/add_trigger") << 7;
  }
  void TearDown() override {
    Iio::TearDown();
    if (!IsSkipped()) std::ofstream("/sys/bus/iio/devices/iio_sysfs_trigger/remove_trigger") << 7;
  }
};

TEST_F(PulsedIio, EveryPulseGivesOneConversionThatMatchesIt) {
  const GpioSim sim("eyebox-pulse", 0, "PULSE");
  auto trigger = OpenTrigger(sim.chip() + ":PULSE", SystemClock());
  ASSERT_TRUE(trigger.ok()) << trigger.status();
  auto photodiode = Open("voltage0?trigger=sysfstrig7");
  ASSERT_TRUE(photodiode.ok()) << photodiode.status();
  ASSERT_TRUE((*photodiode)->Configure({.pulse_started = true}).ok());
  ASSERT_TRUE((*photodiode)->Start().ok());
  EXPECT_TRUE(absl::IsDeadlineExceeded((*photodiode)->Read(milliseconds(50)).status()));
  std::vector<int64_t> pulses_ns;
  std::vector<int64_t> samples_ns;
  {
    const Wire wire(&sim, 0);
    for (int i = 0; i < 20; ++i) {
      const auto pulse = (*trigger)->Fire(milliseconds(40));
      ASSERT_TRUE(pulse.ok()) << pulse.status();
      pulses_ns.push_back(pulse->on.before_ns);
      std::this_thread::sleep_for(milliseconds(40));
    }
  }
  while (samples_ns.size() < pulses_ns.size()) {
    const auto block = (*photodiode)->Read(milliseconds(5000));
    ASSERT_TRUE(block.ok()) << block.status() << " after " << samples_ns.size();
    for (const auto& sample : block->samples) samples_ns.push_back(sample.monotonic_ns);
  }
  const auto match = MatchEdges(pulses_ns, samples_ns, {.earliest_ns = 0, .latest_ns = 79'000'000});
  ASSERT_TRUE(match.ok()) << match.status();
  EXPECT_TRUE(CheckComplete(*match, "pulse").ok()) << CheckComplete(*match, "pulse");
  EXPECT_TRUE((*photodiode)->Stop().ok());
}

TEST_F(PulsedIio, ATriggerWithoutRateCannotBeTimed) {
  auto photodiode = Open("voltage0?trigger=sysfstrig7");
  ASSERT_TRUE(photodiode.ok()) << photodiode.status();
  EXPECT_TRUE(absl::IsInvalidArgument((*photodiode)->Configure({}).status()));
}

TEST_F(Iio, WhatIsNotThereIsNamedWithWhatIs) {
  const auto device = OpenPhotodiode({.uri = "iio:nobody/voltage0"}, SystemClock());
  EXPECT_TRUE(absl::IsNotFound(device.status()));
  EXPECT_THAT(device.status().message(), HasSubstr("eyebox_adc"));
  const auto channel = Open("voltage77");
  EXPECT_TRUE(absl::IsNotFound(channel.status()));
  EXPECT_THAT(channel.status().message(), HasSubstr("voltage0"));
  EXPECT_TRUE(absl::IsNotFound(Open("voltage0?trigger=nobody").status()));
}

}  // namespace
}  // namespace eyebox::capture
