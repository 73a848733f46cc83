// A run that is interrupted and goes on: a camera that comes back, a disk that fails, a recording
// that is resumed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "capture/camera/sim/sim_rig.h"
#include "capture/plan.h"
#include "capture/recording/recover.h"
#include "capture/recording/remaining.h"
#include "capture/run.h"
#include "tests/support/faulty_camera.h"
#include "tests/support/memory_recording.h"
#include "tests/support/temporary_folder.h"

namespace eyebox::capture {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::SizeIs;

constexpr int64_t kRealNs = 1700000000000000000;

Rig OpenSmallRig(const Clock* clock) {
  SimParameters parameters;
  parameters.sensor.size = {.width_px = 8, .height_px = 6};
  const RigConfig config = {.name = "test", .camera_uri = "sim:rift-s-like", .seed = 4};
  auto rig = OpenSimRig(config, parameters, clock);
  EXPECT_TRUE(rig.ok()) << rig.status();
  return *std::move(rig);
}

CapturePlan SmallPlan() {
  return *MakeGreyPlan({.levels = 3,
                        .exposures_s = {0.01},
                        .repeats = 3,
                        .dark_repeats = 2,
                        .flat_repeats = 0,
                        .reference_every = 2});  // d R l l R l R
}

// A wall clock that is set by an hour, to and fro, at every look.
class SteppingClock final : public Clock {
 public:
  int64_t MonotonicNs() const override { return monotonic_ns_ += 1'000'000; }
  int64_t RealNs() const override {
    step_ns_ = -step_ns_;
    return kRealNs + step_ns_;
  }

 private:
  mutable int64_t monotonic_ns_ = 10;
  mutable int64_t step_ns_ = 3'600'000'000'000;
};

class Reopening : public testing::Test {
 protected:
  // The n-th frame of all finds the camera gone; `reopen` opens one that shares its headset.
  void LoseAt(std::vector<int> frames) {
    auto camera = std::shared_ptr<Camera>(std::move(rig_.camera));
    const auto open = [this, camera, frames] {
      return std::make_unique<FaultyCamera>(
          std::make_unique<Borrowed>(camera), [this, frames](int) {
            const bool lost = std::ranges::find(frames, frame_++) != frames.end();
            return lost ? CameraFault::kLost : CameraFault::kNone;
          });
    };
    rig_.camera = open();
    options_.reopen = [this, open]() -> absl::StatusOr<std::unique_ptr<Camera>> {
      EXPECT_EQ(rig_.camera, nullptr) << "the lost camera still holds the device";
      ++reopened_;
      return open();
    };
  }

  class Borrowed final : public Camera {
   public:
    explicit Borrowed(std::shared_ptr<Camera> camera) : camera_(std::move(camera)) {}
    ~Borrowed() override { EXPECT_TRUE(camera_->Stop().ok()); }
    const CameraInfo& Info() const override { return camera_->Info(); }
    absl::StatusOr<CameraSettings> Configure(const CameraSettings& settings) override {
      configured_ = true;
      return camera_->Configure(settings);
    }
    absl::Status Start() override {
      EXPECT_TRUE(configured_) << "a camera that was opened again was not set again";
      return camera_->Start();
    }
    absl::Status Trigger() override { return camera_->Trigger(); }
    absl::Status Stop() override { return camera_->Stop(); }
    absl::StatusOr<Frame> NextFrame(std::chrono::milliseconds timeout) override {
      return camera_->NextFrame(timeout);
    }

   private:
    const std::shared_ptr<Camera> camera_;
    bool configured_ = false;
  };

  ManualClock clock_{10, kRealNs};
  Rig rig_ = OpenSmallRig(&clock_);
  const CapturePlan plan_ = SmallPlan();
  MemoryRecording recording_;
  RunOptions options_;
  int frame_ = 0;
  int reopened_ = 0;
};

TEST_F(Reopening, ALostCameraIsOpenedOnceAndTheCaptureTakenAgain) {
  LoseAt({3});  // the second frame of the second capture
  const auto report = RunPlan(rig_, plan_, recording_, options_);
  ASSERT_TRUE(report.ok()) << report.status();
  EXPECT_EQ(report->cameras_reopened, 1);
  EXPECT_EQ(report->captures, 7);
  EXPECT_THAT(report->remarks, ElementsAre(AllOf(HasSubstr("capture 2"), HasSubstr("lost"))));
  ASSERT_THAT(recording_.Published(), SizeIs(7));
  for (const auto& capture : recording_.Published()) {
    EXPECT_THAT(capture->frames, SizeIs(static_cast<size_t>(capture->spec.repeats)));
  }
}

TEST_F(Reopening, ACameraThatIsLostAgainEndsTheRun) {
  LoseAt({3, 9});
  const auto report = RunPlan(rig_, plan_, recording_, options_);
  EXPECT_TRUE(absl::IsUnavailable(report.status())) << report.status();
  EXPECT_EQ(reopened_, 1);
  EXPECT_THAT(recording_.Published(), SizeIs(2));
}

TEST_F(Reopening, ACameraThatCannotBeOpenedAgainEndsTheRun) {
  LoseAt({3});
  options_.reopen = []() -> absl::StatusOr<std::unique_ptr<Camera>> {
    return absl::NotFoundError("nobody answers");
  };
  const auto report = RunPlan(rig_, plan_, recording_, options_);
  EXPECT_TRUE(absl::IsNotFound(report.status())) << report.status();
  EXPECT_THAT(recording_.Published(), SizeIs(1));
}

TEST_F(Reopening, AnotherCameraInItsPlaceIsRefused) {
  LoseAt({3});
  options_.reopen = [this]() -> absl::StatusOr<std::unique_ptr<Camera>> {
    SimParameters other;
    other.sensor.size = {.width_px = 10, .height_px = 6};
    auto rig = OpenSimRig({.name = "o", .camera_uri = "sim:o"}, other, &clock_);
    return std::move(rig->camera);
  };
  const auto report = RunPlan(rig_, plan_, recording_, options_);
  EXPECT_TRUE(absl::IsUnavailable(report.status()));
  EXPECT_THAT(std::string(report.status().message()), HasSubstr("another camera"));
}

// Fails at the n-th Append of all, as a disk that is pulled.
class FailingRecording final : public RecordingWriter {
 public:
  FailingRecording(RecordingWriter& writer, int at) : writer_(writer), left_(at) {}
  absl::StatusOr<std::unique_ptr<CaptureWriter>> BeginCapture(const CaptureSpec& spec,
                                                              ImageSize size,
                                                              const SideRoom& room) override {
    auto capture = writer_.BeginCapture(spec, size, room);
    if (!capture.ok()) return std::move(capture).status();
    return std::make_unique<Failing>(*std::move(capture), left_);
  }
  absl::Status SuspectSince(int first, const std::string& reason) override {
    return writer_.SuspectSince(first, reason);
  }
  int PublishedCount() const override { return writer_.PublishedCount(); }

 private:
  class Failing final : public CaptureWriter {
   public:
    Failing(std::unique_ptr<CaptureWriter> capture, int& left)
        : capture_(std::move(capture)), left_(left) {}
    absl::Status Append(const Frame& frame) override {
      if (left_-- == 0) return absl::InternalError("the disk is gone");
      return capture_->Append(frame);
    }
    absl::Status AppendSamples(const SampleBlock& block) override {
      return capture_->AppendSamples(block);
    }
    absl::Status AppendClockTriple(const ClockTriple& triple) override {
      return capture_->AppendClockTriple(triple);
    }
    int64_t samples_lost() const override { return capture_->samples_lost(); }
    absl::Status Acknowledge() override { return capture_->Acknowledge(); }
    absl::Status Publish() override { return capture_->Publish(); }
    absl::Status PublishEarly() override { return capture_->PublishEarly(); }

   private:
    const std::unique_ptr<CaptureWriter> capture_;
    int& left_;
  };
  RecordingWriter& writer_;
  int left_;
};

// As eyebox capture --resume does it.
absl::StatusOr<RunReport> Resume(Rig& rig, const std::filesystem::path& recording,
                                 const RunOptions& options = {}) {
  EXPECT_TRUE(RecoverRecording(recording).ok());
  const auto reader = *RecordingReader::Open(recording);
  const CapturePlan left = RemainingCaptures(reader->Header().plan, reader->Captures());
  const auto writer = RecordingWriter::Resume(recording);
  EXPECT_TRUE(writer.ok()) << writer.status();
  return RunPlan(rig, left, **writer, options);
}

std::vector<CaptureSpec> WholeCaptures(const std::filesystem::path& recording) {
  const auto reader = *RecordingReader::Open(recording);
  std::vector<CaptureSpec> specs;
  for (const CaptureEntry& capture : reader->Captures()) {
    if (capture.frame_count == capture.spec.repeats && capture.suspect.empty()) {
      specs.push_back(capture.spec);
    }
  }
  return specs;
}

class ResumedRun : public testing::TestWithParam<int> {
 protected:
  const TemporaryFolder folder_;
  const std::filesystem::path path_ = folder_ / "recording";
  ManualClock clock_{10, kRealNs};
  Rig rig_ = OpenSmallRig(&clock_);
  const CapturePlan plan_ = SmallPlan();
};

TEST_P(ResumedRun, TakesWhatIsLeftWhereverItBroke) {
  {
    const auto writer = RecordingWriter::Create(path_, MakeHeader(rig_, plan_, clock_), &clock_);
    ASSERT_TRUE(writer.ok()) << writer.status();
    FailingRecording failing(**writer, GetParam());
    EXPECT_TRUE(absl::IsInternal(RunPlan(rig_, plan_, failing).status()));
  }
  const auto report = Resume(rig_, path_);
  ASSERT_TRUE(report.ok()) << report.status();
  EXPECT_EQ(WholeCaptures(path_), plan_.captures) << "each once, in the order of the plan";
  EXPECT_TRUE(VerifyRecording(path_).ok());
}

INSTANTIATE_TEST_SUITE_P(Frame, ResumedRun, testing::Values(0, 1, 2, 5, 6, 8, 21));

using SleepyRun = ResumedRun;

TEST_F(SleepyRun, SuspectCapturesAreTakenAgain) {
  {
    auto writer = *RecordingWriter::Create(path_, MakeHeader(rig_, plan_, clock_), &clock_);
    ASSERT_TRUE(RunPlan(rig_, plan_, *writer).ok());
    ASSERT_TRUE(writer->SuspectSince(6, "the headset slept").ok());
  }
  EXPECT_THAT(WholeCaptures(path_), SizeIs(5));
  std::vector<int> numbers;
  RunOptions options;
  options.published = [&numbers](const CaptureFigures& figures) {
    numbers.push_back(figures.reading.number);
    return absl::OkStatus();
  };
  const auto report = Resume(rig_, path_, options);
  ASSERT_TRUE(report.ok()) << report.status();
  EXPECT_THAT(numbers, ElementsAre(8, 9)) << "numbers are those of the files";
  EXPECT_EQ(WholeCaptures(path_), plan_.captures);
}

TEST(RunOnAWallClockThatIsSet, GoesOnUndisturbed) {
  const SteppingClock clock;
  Rig rig = OpenSmallRig(&clock);
  MemoryRecording recording;
  RunOptions options;
  options.settle = SettleOptions{};
  const auto report = RunPlan(rig, SmallPlan(), recording, options);
  ASSERT_TRUE(report.ok()) << report.status();
  EXPECT_EQ(report->captures_taken_again, 0);
  int64_t before_ns = 0;
  for (const auto& capture : recording.Published()) {
    for (const Frame& frame : capture->frames) {
      EXPECT_GT(frame.metadata.monotonic_time_ns, before_ns);
      before_ns = frame.metadata.monotonic_time_ns;
    }
  }
  EXPECT_LT(before_ns, kRealNs) << "a frame carries the wall clock";
}

}  // namespace
}  // namespace eyebox::capture
