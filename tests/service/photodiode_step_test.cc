#include "service/steps/photodiode.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "capture/photodiode/sim/strobe_light.h"

namespace eyebox::service {
namespace {

// One capture, of these samples or these frames.
class OneCapture final : public capture::RecordingReader {
 public:
  const capture::RecordingHeader& Header() const override { return header_; }
  std::span<const capture::CaptureEntry> Captures() const override { return {&entry_, 1}; }

  absl::Status VisitFrames(const capture::CaptureEntry&, const FrameVisitor& visit) override {
    for (const std::optional<double>& counts : stated) {
      Frame frame;
      frame.metadata.photodiode_counts = counts;
      if (const absl::Status status = visit(frame); !status.ok()) return status;
    }
    return absl::OkStatus();
  }
  absl::Status VisitSamples(const capture::CaptureEntry&, const SampleVisitor& visit) override {
    return samples.empty() ? absl::OkStatus() : visit({.samples = samples});
  }
  absl::StatusOr<std::vector<ClockTriple>> ClockTriples(const capture::CaptureEntry&) override {
    return std::vector<ClockTriple>();
  }

  std::optional<PhotodiodeMean> Read() {
    entry_.sample_count = static_cast<int64_t>(samples.size());
    const auto mean = ReadPhotodiode(*this, entry_);
    EXPECT_TRUE(mean.ok()) << mean.status();
    return *mean;
  }

  std::vector<capture::PhotodiodeSample> samples;
  std::vector<std::optional<double>> stated = {std::nullopt};

 private:
  capture::RecordingHeader header_;
  capture::CaptureEntry entry_;
};

TEST(PhotodiodeReading, OfADisplayThatFlashesDoesNotKnowThePhase) {
  constexpr double kRateHz = 200000;
  for (const double flashes : {8.0, 8.5, 12.3}) {
    for (const double phase : {0.0, 0.3, 0.7}) {
      const capture::StrobeLight light = {.period_s = 0.01, .duty = 0.2, .phase_s = 0.01 * phase};
      OneCapture capture;
      for (int k = 0; k < kRateHz * flashes * light.period_s; ++k) {
        capture.samples.push_back(
            {std::llround(1e9 * k / kRateHz), static_cast<int32_t>(50000 * light.At(k / kRateHz))});
      }
      // The ripple is 1.9 of the mean; a plain mean of 8.5 flashes is off by up to 6 %.
      EXPECT_NEAR(capture.Read()->counts / 1e4, 1, 2e-3) << flashes << " flashes, phase " << phase;
    }
  }
}

TEST(PhotodiodeReading, OfOneConversionIsThatConversion) {
  OneCapture capture;
  capture.samples = {{5, 321}};
  EXPECT_EQ(capture.Read()->counts, 321);
  EXPECT_EQ(capture.Read()->readings, 1);
}

TEST(PhotodiodeReading, OnTheRailIsClipped) {
  OneCapture capture;
  for (int k = 0; k < 100; ++k) capture.samples.push_back({k, k < 10 ? 4095 : 4000});
  EXPECT_TRUE(capture.Read()->clipped);
  for (auto& sample : capture.samples) sample.counts -= 1;
  EXPECT_FALSE(capture.Read()->clipped);
}

TEST(PhotodiodeReading, OfImportedFramesIsTheMeanOfWhatTheyState) {
  OneCapture capture;
  capture.stated = {10, 30, std::nullopt, std::numeric_limits<double>::quiet_NaN(), 50};
  EXPECT_EQ(capture.Read()->counts, 30);
  EXPECT_EQ(capture.Read()->readings, 3);
}

TEST(PhotodiodeReading, IsNoneWhereNothingWasRead) {
  EXPECT_FALSE(OneCapture().Read().has_value());
}

}  // namespace
}  // namespace eyebox::service
