// A run with a trigger: its pulses start the camera, if wired, and the photodiode.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>

#include "capture/camera/rig.h"
#include "capture/plan.h"
#include "capture/run.h"
#include "tests/support/memory_recording.h"

namespace eyebox::capture {
namespace {

using testing::SizeIs;

constexpr char kTriggerUri[] = "sim:run-trigger";
constexpr int kLevels = 2;
constexpr int kRepeats = 3;

std::unique_ptr<EdgeSource> PulseInput() {
  auto edges = OpenEdgeSource(kTriggerUri, EdgeKind::kRising, SystemClock());
  EXPECT_TRUE(edges.ok()) << edges.status();
  return *std::move(edges);
}

// A camera with an input: what it exposes, a pulse has started.
class LineCamera final : public Camera {
 public:
  explicit LineCamera(std::unique_ptr<Camera> camera)
      : camera_(std::move(camera)), info_(camera_->Info()), pulses_(PulseInput()) {
    info_.trigger_lines = {"Line0"};
  }
  const CameraInfo& Info() const override { return info_; }
  absl::StatusOr<CameraSettings> Configure(const CameraSettings& settings) override {
    by_line_ = settings.trigger == TriggerSource::kLine && settings.trigger_line == "Line0";
    return camera_->Configure({.exposure_s = settings.exposure_s, .gain_db = settings.gain_db});
  }
  absl::Status Start() override { return camera_->Start(); }
  absl::Status Trigger() override {
    if (by_line_) return absl::FailedPreconditionError("the line triggers");
    return camera_->Trigger();
  }
  absl::StatusOr<Frame> NextFrame(std::chrono::milliseconds timeout) override {
    if (!by_line_) return camera_->NextFrame(timeout);
    const auto edges = pulses_->Take(timeout);
    if (!edges.ok()) return edges.status();
    for (size_t i = 0; i < edges->edges.size(); ++i) {
      if (absl::Status status = camera_->Trigger(); !status.ok()) return status;
    }
    return camera_->NextFrame(timeout);
  }
  absl::Status Stop() override { return camera_->Stop(); }

 private:
  const std::unique_ptr<Camera> camera_;
  CameraInfo info_;
  const std::unique_ptr<EdgeSource> pulses_;
  bool by_line_ = false;
};

// A converter that converts once a pulse, but for the pulse number `deaf_to` since opening.
class PulsedPhotodiode final : public Photodiode {
 public:
  explicit PulsedPhotodiode(int deaf_to) : pulses_(PulseInput()), deaf_to_(deaf_to) {
    info_.uri = "pulsed";
    info_.sample_rate_max_hz = 1000;
    info_.can_be_pulse_started = true;
  }
  const PhotodiodeInfo& Info() const override { return info_; }
  absl::StatusOr<PhotodiodeSettings> Configure(const PhotodiodeSettings& settings) override {
    EXPECT_TRUE(settings.pulse_started);
    return settings;
  }
  absl::Status Start() override { return pulses_->Take(std::chrono::milliseconds(0)).status(); }
  absl::StatusOr<SampleBlock> Read(std::chrono::milliseconds timeout) override {
    const auto edges = pulses_->Take(timeout);
    if (!edges.ok()) return edges.status();
    SampleBlock block;
    for (const Edge& edge : edges->edges) {
      if (pulse_++ == deaf_to_) continue;
      PhotodiodeSample sample;
      sample.monotonic_ns = edge.monotonic_ns;
      sample.counts = 7;
      block.samples.push_back(sample);
    }
    if (block.samples.empty()) return absl::DeadlineExceededError("nothing came");
    return block;
  }
  absl::Status Stop() override { return absl::OkStatus(); }

 private:
  PhotodiodeInfo info_;
  const std::unique_ptr<EdgeSource> pulses_;
  const int deaf_to_;
  int pulse_ = 0;
};

class RunWithTrigger : public testing::Test {
 protected:
  void Open(const std::string& camera_trigger_line) {
    auto rig = OpenRig({.name = "test",
                        .camera_uri = "sim:rift-s-like",
                        .trigger_uri = kTriggerUri,
                        .camera_trigger_line = camera_trigger_line},
                       SystemClock());
    ASSERT_TRUE(rig.ok()) << rig.status();
    rig_ = *std::move(rig);
    ASSERT_NE(rig_.trigger, nullptr);
    rig_.camera = std::make_unique<LineCamera>(std::move(rig_.camera));
    auto plan = MakeGreyPlan({.levels = kLevels,
                              .exposures_s = {0.01},
                              .repeats = kRepeats,
                              .dark_repeats = kRepeats,
                              .flat_repeats = 0});
    ASSERT_TRUE(plan.ok()) << plan.status();
    plan_ = *std::move(plan);
  }

  Rig rig_;
  CapturePlan plan_;
  MemoryRecording recording_;
};

TEST_F(RunWithTrigger, AWiredCameraExposesOncePerPulseAndItsFramesCarryThePulsesTime) {
  Open("Line0");
  const auto report = RunPlan(rig_, plan_, recording_);
  ASSERT_TRUE(report.ok()) << report.status();
  EXPECT_EQ(report->captures_taken_again, 0);
  const RecordingHeader header = MakeHeader(rig_, plan_, *SystemClock());
  EXPECT_EQ(header.camera_settings->trigger, TriggerSource::kLine);
  EXPECT_EQ(header.camera_settings->trigger_line, "Line0");
  int64_t last_ns = 0;
  for (const auto& capture : recording_.Published()) {
    ASSERT_THAT(capture->frames, SizeIs(kRepeats));
    for (const Frame& frame : capture->frames) {
      ASSERT_TRUE(frame.metadata.trigger_time_ns.has_value());
      EXPECT_GT(*frame.metadata.trigger_time_ns, last_ns);
      EXPECT_LE(*frame.metadata.trigger_time_ns, frame.metadata.monotonic_time_ns);
      last_ns = *frame.metadata.trigger_time_ns;
    }
  }
  EXPECT_THAT(recording_.Published(), SizeIs(kLevels + 1));
}

TEST_F(RunWithTrigger, APulsedPhotodiodeConvertsOnceAFrame) {
  Open("");
  rig_.photodiode = std::make_unique<PulsedPhotodiode>(-1);
  const auto report = RunPlan(rig_, plan_, recording_);
  ASSERT_TRUE(report.ok()) << report.status();
  EXPECT_EQ(report->samples, report->frames);
  for (const auto& capture : recording_.Published()) EXPECT_EQ(capture->samples, kRepeats);
}

TEST_F(RunWithTrigger, ACaptureWithALostConversionIsTakenAgain) {
  Open("");
  rig_.photodiode = std::make_unique<PulsedPhotodiode>(kRepeats + 1);  // in the second capture
  const auto report = RunPlan(rig_, plan_, recording_);
  ASSERT_TRUE(report.ok()) << report.status();
  EXPECT_EQ(report->captures_taken_again, 1);
  for (const auto& capture : recording_.Published()) EXPECT_EQ(capture->samples, kRepeats);
}

}  // namespace
}  // namespace eyebox::capture
