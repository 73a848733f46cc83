#include "capture/run.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "capture/base/version.h"
#include "capture/camera/sim/sim_rig.h"
#include "capture/plan.h"
#include "tests/support/faulty_camera.h"
#include "tests/support/memory_recording.h"

namespace eyebox::capture {
namespace {

using testing::HasSubstr;

class Run : public testing::Test {
 protected:
  void SetUp() override {
    SimParameters parameters;
    parameters.sensor.size = {.width_px = 8, .height_px = 6};
    const RigConfig config = {.name = "test", .camera_uri = "sim:rift-s-like", .seed = 4};
    auto rig = OpenSimRig(config, parameters, &clock_);
    ASSERT_TRUE(rig.ok()) << rig.status();
    rig_ = *std::move(rig);
    auto plan = MakeGreyPlan(
        {.levels = 2, .exposures_s = {0.01}, .repeats = 3, .dark_repeats = 2, .flat_repeats = 0});
    ASSERT_TRUE(plan.ok()) << plan.status();
    plan_ = *std::move(plan);  // a dark of 2 frames, then 2 levels of 3
  }

  void Inject(FaultyCamera::FaultOf fault) {
    rig_.camera = std::make_unique<FaultyCamera>(std::move(rig_.camera), std::move(fault));
  }

  // The n-th frame of all (from 0), and no other, meets this fault.
  void InjectOnce(int n, CameraFault fault) {
    Inject([n, fault](int frame) { return frame == n ? fault : CameraFault::kNone; });
  }

  ManualClock clock_{10, 1700000000000000000};
  Rig rig_;
  CapturePlan plan_;
  MemoryRecording recording_;
};

TEST_F(Run, WritesAcknowledgesAndPublishesEveryCaptureInOrder) {
  const auto report = RunPlan(rig_, plan_, recording_);
  ASSERT_TRUE(report.ok()) << report.status();
  EXPECT_EQ(report->captures, 3);
  EXPECT_EQ(report->frames, 8);
  EXPECT_EQ(report->captures_taken_again, 0);
  ASSERT_EQ(recording_.captures().size(), 3);
  for (size_t i = 0; i < 3; ++i) {
    const MemoryCapture& capture = *recording_.captures()[i];
    EXPECT_TRUE(capture.published);
    EXPECT_EQ(capture.spec, plan_.captures[i]);
    EXPECT_EQ(capture.frames.size(), static_cast<size_t>(capture.spec.repeats));
    for (const Frame& frame : capture.frames) {
      EXPECT_EQ(frame.metadata.exposure_asked_s, capture.spec.exposure_s);
    }
  }
}

TEST_F(Run, AcknowledgesInGroups) {
  class Counting final : public RecordingWriter {
   public:
    absl::StatusOr<std::unique_ptr<CaptureWriter>> BeginCapture(const CaptureSpec&, ImageSize,
                                                                const SideRoom&) override {
      return std::make_unique<Writer>(groups);
    }
    absl::Status SuspectSince(int, const std::string&) override { return absl::OkStatus(); }
    int PublishedCount() const override { return 0; }
    std::vector<int> groups;

   private:
    struct Writer final : CaptureWriter {
      explicit Writer(std::vector<int>& all) : groups(all) {}
      absl::Status Append(const Frame&) override { return ++pending, absl::OkStatus(); }
      absl::Status AppendSamples(const SampleBlock&) override { return absl::OkStatus(); }
      absl::Status AppendClockTriple(const ClockTriple&) override { return absl::OkStatus(); }
      int64_t samples_lost() const override { return 0; }
      absl::Status Acknowledge() override {
        groups.push_back(pending);
        pending = 0;
        return absl::OkStatus();
      }
      absl::Status Publish() override { return absl::OkStatus(); }
      absl::Status PublishEarly() override { return absl::OkStatus(); }
      std::vector<int>& groups;
      int pending = 0;
    };
  };
  Counting writer;
  ASSERT_TRUE(RunPlan(rig_, plan_, writer, {.frames_per_acknowledgement = 2}).ok());
  EXPECT_THAT(writer.groups, testing::ElementsAre(2, 2, 1, 2, 1));
}

struct Fault {
  CameraFault fault;
  const char* words;
};

class RunWithFault : public Run, public testing::WithParamInterface<Fault> {};

TEST_P(RunWithFault, TakesTheCaptureAgain) {
  InjectOnce(3, GetParam().fault);  // the second frame of the second capture
  const auto report = RunPlan(rig_, plan_, recording_);
  ASSERT_TRUE(report.ok()) << report.status();
  EXPECT_EQ(report->captures, 3);
  EXPECT_EQ(report->captures_taken_again, 1);
  EXPECT_EQ(recording_.captures().size(), 4);
  const auto published = recording_.Published();
  ASSERT_EQ(published.size(), 3);
  for (const auto& capture : published) {
    ASSERT_EQ(capture->frames.size(), static_cast<size_t>(capture->spec.repeats));
    for (size_t i = 0; i < capture->frames.size(); ++i) {
      const FrameMetadata& metadata = capture->frames[i].metadata;
      EXPECT_EQ(metadata.status, BufferStatus::kComplete);
      EXPECT_EQ(metadata.camera_frame_id, capture->frames[0].metadata.camera_frame_id + i);
      EXPECT_EQ(metadata.exposure_reported_s, capture->spec.exposure_s);
    }
  }
}

TEST_P(RunWithFault, FailsNamingCaptureAndFrameWhenItPersists) {
  // Every frame of the second capture but the first, on every attempt.
  Inject([this, spoilt = size_t{0}](int) mutable {
    const size_t begun = recording_.captures().size();
    const bool first_frame = begun != std::exchange(spoilt, begun);
    return begun < 2 || first_frame ? CameraFault::kNone : GetParam().fault;
  });
  const auto report = RunPlan(rig_, plan_, recording_, {.attempts = 3});
  EXPECT_TRUE(absl::IsUnavailable(report.status())) << report.status();
  const std::string message(report.status().message());
  EXPECT_THAT(message, HasSubstr("capture 2"));
  EXPECT_THAT(message, HasSubstr("3 times"));
  EXPECT_THAT(message, HasSubstr(GetParam().words));
  EXPECT_EQ(recording_.captures().size(), 1 + 3);
  EXPECT_EQ(recording_.Published().size(), 1);
}

INSTANTIATE_TEST_SUITE_P(
    Faults, RunWithFault,
    testing::Values(Fault{CameraFault::kDropped, "frame 11 came after frame 9"},
                    Fault{CameraFault::kIncomplete, "frame 8 misses packets"},
                    Fault{CameraFault::kTimedOut, "did not arrive"},
                    Fault{CameraFault::kLate, "did not arrive"},
                    Fault{CameraFault::kDuplicated, ": it came twice or late"},
                    Fault{CameraFault::kReordered, "frame 11 came after frame 9"},
                    Fault{CameraFault::kOldExposure, "frame 8 reports an exposure of 0.015"},
                    Fault{CameraFault::kOtherGain, "frame 8 reports a gain of 6"}));

TEST_F(Run, ALostCameraEndsTheRunAtOnce) {
  InjectOnce(3, CameraFault::kLost);
  const auto report = RunPlan(rig_, plan_, recording_);
  EXPECT_TRUE(absl::IsUnavailable(report.status()));
  EXPECT_EQ(recording_.captures().size(), 2);
  EXPECT_EQ(recording_.Published().size(), 1);
}

TEST_F(Run, CancelledBetweenFramesLeavesTheCaptureUnpublished) {
  int asked = 0;
  const auto report =
      RunPlan(rig_, plan_, recording_, {.cancelled = [&asked] { return ++asked > 3; }});
  EXPECT_TRUE(absl::IsCancelled(report.status()));
  EXPECT_EQ(recording_.captures().size(), 2);
  EXPECT_EQ(recording_.Published().size(), 1);
  EXPECT_TRUE(rig_.camera->Configure({.exposure_s = 0.02}).ok()) << "the camera was left running";
}

TEST_F(Run, TellsItsProgress) {
  std::vector<int> done;
  ASSERT_TRUE(RunPlan(rig_, plan_, recording_,
                      {.progress =
                           [&](const RunProgress& progress) {
                             EXPECT_EQ(progress.captures_total, 3);
                             EXPECT_EQ(progress.next,
                                       plan_.captures[static_cast<size_t>(progress.captures_done)]);
                             done.push_back(progress.captures_done);
                           }})
                  .ok());
  EXPECT_THAT(done, testing::ElementsAre(0, 1, 2));
}

TEST_F(Run, RefusesAnExposureBeyondTheCameraBeforeAnyLightIsMeasured) {
  plan_.captures.back().exposure_s = 1000;
  const auto report = RunPlan(rig_, plan_, recording_);
  EXPECT_TRUE(absl::IsInvalidArgument(report.status()));
  EXPECT_THAT(std::string(report.status().message()), HasSubstr("capture 3"));
  EXPECT_THAT(std::string(report.status().message()), HasSubstr("exposure_s"));
  EXPECT_TRUE(recording_.captures().empty());
}

TEST_F(Run, RefusesAnEmptyPlanAndACaptureWithoutFrames) {
  EXPECT_TRUE(absl::IsInvalidArgument(RunPlan(rig_, {}, recording_).status()));
  plan_.captures.front().repeats = 0;
  EXPECT_TRUE(absl::IsInvalidArgument(RunPlan(rig_, plan_, recording_).status()));
}

TEST_F(Run, RefusesOptionsByName) {
  EXPECT_THAT(std::string(RunPlan(rig_, plan_, recording_, {.attempts = 0}).status().message()),
              HasSubstr("attempts"));
  EXPECT_THAT(
      std::string(RunPlan(rig_, plan_, recording_, {.exposure_tolerance = -1}).status().message()),
      HasSubstr("exposure_tolerance"));
}

TEST_F(Run, ACameraThatCannotHoldAnExposureIsRefused) {
  class Rounding final : public Camera {
   public:
    explicit Rounding(std::unique_ptr<Camera> camera) : camera_(std::move(camera)) {}
    const CameraInfo& Info() const override { return camera_->Info(); }
    absl::StatusOr<CameraSettings> Configure(const CameraSettings& settings) override {
      auto set = camera_->Configure(settings);
      if (set.ok()) set->exposure_s *= 1.01;
      return set;
    }
    absl::Status Start() override { return camera_->Start(); }
    absl::Status Trigger() override { return camera_->Trigger(); }
    absl::Status Stop() override { return camera_->Stop(); }
    absl::StatusOr<Frame> NextFrame(std::chrono::milliseconds timeout) override {
      return camera_->NextFrame(timeout);
    }

   private:
    std::unique_ptr<Camera> camera_;
  };
  rig_.camera = std::make_unique<Rounding>(std::move(rig_.camera));
  const auto report = RunPlan(rig_, plan_, recording_);
  EXPECT_TRUE(absl::IsUnavailable(report.status()));
  EXPECT_THAT(std::string(report.status().message()), HasSubstr("reads back 0.0101"));
}

TEST_F(Run, HeaderSaysWhatMadeTheRecording) {
  const RecordingHeader header = MakeHeader(rig_, plan_, clock_);
  EXPECT_EQ(header.origin, RecordingOrigin::kSimulated);
  EXPECT_EQ(header.rig.camera_uri, "sim:rift-s-like");
  EXPECT_EQ(header.rig.seed, 4);
  EXPECT_EQ(header.camera.sensor_size, (ImageSize{.width_px = 8, .height_px = 6}));
  ASSERT_TRUE(header.geometry.has_value());
  EXPECT_EQ(header.geometry->focal_length_px, 219.8);
  EXPECT_EQ(header.plan.captures, plan_.captures);
  EXPECT_EQ(header.software_version, kVersion);
  EXPECT_EQ(header.created_real_ns, 1700000000000000000);
}

}  // namespace
}  // namespace eyebox::capture
