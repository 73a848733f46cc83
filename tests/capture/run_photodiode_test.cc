// A run with a photodiode: its samples stand with the frames that they were taken beside.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "capture/camera/rig.h"
#include "capture/plan.h"
#include "capture/recording/reader.h"
#include "capture/run.h"
#include "tests/support/memory_recording.h"
#include "tests/support/temporary_folder.h"

namespace eyebox::capture {
namespace {

using testing::AllOf;
using testing::Each;
using testing::Field;
using testing::Ge;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Le;
using testing::SizeIs;

constexpr int64_t kStepNs = 20'000'000;  // that pass before every frame
constexpr double kRateHz = 1000;

// Passes calls on, and is unplugged at the n-th Read() of all for as many as `often`.
class Unplugged final : public Photodiode {
 public:
  Unplugged(std::unique_ptr<Photodiode> photodiode, int at, int often)
      : photodiode_(std::move(photodiode)), left_(at), often_(often) {}
  const PhotodiodeInfo& Info() const override { return photodiode_->Info(); }
  absl::StatusOr<PhotodiodeSettings> Configure(const PhotodiodeSettings& settings) override {
    return photodiode_->Configure(settings);
  }
  absl::Status Start() override { return photodiode_->Start(); }
  absl::StatusOr<SampleBlock> Read(std::chrono::milliseconds timeout) override {
    if (left_-- <= 0 && often_-- > 0) return absl::UnavailableError(Info().uri + " is unplugged");
    return photodiode_->Read(timeout);
  }
  absl::Status Stop() override { return photodiode_->Stop(); }

 private:
  const std::unique_ptr<Photodiode> photodiode_;
  int left_;
  int often_;
};

class RunWithPhotodiode : public testing::Test {
 protected:
  void SetUp() override {
    auto rig = OpenRig({.name = "test",
                        .camera_uri = "sim:rift-s-like",
                        .seed = 4,
                        .photodiode_uri = "sim:strobe-90hz"},
                       &clock_);
    ASSERT_TRUE(rig.ok()) << rig.status();
    rig_ = *std::move(rig);
    ASSERT_NE(rig_.photodiode, nullptr);
    auto plan = MakeGreyPlan(
        {.levels = 2, .exposures_s = {0.01}, .repeats = 3, .dark_repeats = 2, .flat_repeats = 0});
    ASSERT_TRUE(plan.ok()) << plan.status();
    plan_ = *std::move(plan);  // a dark of 2 frames, then 2 levels of 3
    options_.clock = &clock_;
    options_.photodiode_rate_hz = kRateHz;
    options_.cancelled = [this] {  // asked before every frame
      clock_.AdvanceNs(kStepNs);
      return false;
    };
  }

  void Unplug(int at, int often) {
    rig_.photodiode = std::make_unique<Unplugged>(std::move(rig_.photodiode), at, often);
  }

  ManualClock clock_{10, 1700000000000000000};
  Rig rig_;
  CapturePlan plan_;
  RunOptions options_;
  MemoryRecording recording_;
};

std::vector<PhotodiodeSample> SamplesOf(const MemoryCapture& capture) {
  std::vector<PhotodiodeSample> samples;
  for (const SampleBlock& block : capture.blocks) {
    samples.insert(samples.end(), block.samples.begin(), block.samples.end());
  }
  return samples;
}

TEST_F(RunWithPhotodiode, SamplesOfACaptureLieWithinItsFramesTimes) {
  const auto report = RunPlan(rig_, plan_, recording_, options_);
  ASSERT_TRUE(report.ok()) << report.status();
  EXPECT_THAT(report->remarks, IsEmpty());
  int64_t samples = 0;
  for (const auto& capture : recording_.Published()) {
    // It began one step before the first frame.
    const int64_t begin_ns = capture->frames.front().metadata.monotonic_time_ns - kStepNs;
    const int64_t end_ns = capture->frames.back().metadata.monotonic_time_ns;
    const std::vector<PhotodiodeSample> taken = SamplesOf(*capture);
    EXPECT_THAT(taken,
                Each(Field(&PhotodiodeSample::monotonic_ns, AllOf(Ge(begin_ns), Le(end_ns)))));
    // One a millisecond, the first and the last included.
    EXPECT_THAT(taken, SizeIs(static_cast<size_t>((end_ns - begin_ns) / 1'000'000 + 1)));
    EXPECT_LE(capture->samples, capture->room.samples);
    samples += capture->samples;
  }
  EXPECT_EQ(report->samples, samples);
  EXPECT_GT(samples, 0);
}

TEST_F(RunWithPhotodiode, ClocksAreReadAtBothEndsOfACapture) {
  ASSERT_TRUE(RunPlan(rig_, plan_, recording_, options_).ok());
  for (const auto& capture : recording_.Published()) {
    ASSERT_THAT(capture->triples, SizeIs(2));
    EXPECT_EQ(capture->triples[0].monotonic_ns,
              capture->frames.front().metadata.monotonic_time_ns - kStepNs);
    EXPECT_EQ(capture->triples[1].monotonic_ns, capture->frames.back().metadata.monotonic_time_ns);
    for (const ClockTriple& triple : capture->triples) {
      EXPECT_EQ(triple.real_ns - triple.monotonic_ns, 1700000000000000000 - 10);
    }
  }
}

TEST_F(RunWithPhotodiode, WithoutOneClocksAreReadAllTheSame) {
  rig_.photodiode = nullptr;
  const auto report = RunPlan(rig_, plan_, recording_, options_);
  ASSERT_TRUE(report.ok()) << report.status();
  EXPECT_EQ(report->samples, 0);
  for (const auto& capture : recording_.Published()) {
    EXPECT_THAT(capture->triples, SizeIs(2));
    EXPECT_EQ(capture->room.samples, 0);
  }
}

TEST_F(RunWithPhotodiode, ACaptureInWhichItFailsIsTakenAgain) {
  Unplug(4, 1);
  const auto report = RunPlan(rig_, plan_, recording_, options_);
  ASSERT_TRUE(report.ok()) << report.status();
  EXPECT_EQ(report->captures, 3);
  EXPECT_EQ(report->captures_taken_again, 1);
  EXPECT_THAT(recording_.captures(), SizeIs(4));
}

TEST_F(RunWithPhotodiode, OneThatKeepsFailingEndsTheRunAndIsNamed) {
  Unplug(4, 1000);
  const auto report = RunPlan(rig_, plan_, recording_, options_);
  EXPECT_TRUE(absl::IsUnavailable(report.status())) << report.status();
  EXPECT_THAT(std::string(report.status().message()),
              HasSubstr("the photodiode failed (sim:strobe-90hz is unplugged)"));
}

TEST_F(RunWithPhotodiode, FramesThatTakeLongerThanExpectedLoseSamplesOfTheFirstCaptureAlone) {
  constexpr int64_t kSlowNs = 2'000'000'000;
  options_.cancelled = [this] {
    clock_.AdvanceNs(kSlowNs);
    return false;
  };
  const auto report = RunPlan(rig_, plan_, recording_, options_);
  ASSERT_TRUE(report.ok()) << report.status();
  ASSERT_THAT(report->remarks, SizeIs(1));
  EXPECT_THAT(report->remarks.front(), HasSubstr("capture 1"));
  EXPECT_THAT(report->remarks.front(), HasSubstr("found no room"));
}

TEST_F(RunWithPhotodiode, WhatWasRecordedCanBeReplayed) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder / "recording";
  {
    auto writer = RecordingWriter::Create(path, MakeHeader(rig_, plan_, clock_), &clock_);
    ASSERT_TRUE(writer.ok()) << writer.status();
    const auto report = RunPlan(rig_, plan_, **writer, options_);
    ASSERT_TRUE(report.ok()) << report.status();
  }
  std::vector<PhotodiodeSample> recorded;
  const auto reader = RecordingReader::Open(path);
  ASSERT_TRUE(reader.ok()) << reader.status();
  for (const CaptureEntry& capture : (*reader)->Captures()) {
    const auto note = [&recorded](const SampleBlock& block) {
      recorded.insert(recorded.end(), block.samples.begin(), block.samples.end());
      return absl::OkStatus();
    };
    ASSERT_TRUE((*reader)->VisitSamples(capture, note).ok());
  }
  const auto replay = OpenPhotodiode({.uri = "replay:" + path.string()}, &clock_);
  ASSERT_TRUE(replay.ok()) << replay.status();
  ASSERT_TRUE((*replay)->Configure({}).ok());
  ASSERT_TRUE((*replay)->Start().ok());
  std::vector<PhotodiodeSample> replayed;
  uint64_t next = 0;
  for (auto block = (*replay)->Read({}); block.ok(); block = (*replay)->Read({})) {
    EXPECT_EQ(block->sequence, next + block->lost_before);
    next = block->sequence + block->samples.size();
    replayed.insert(replayed.end(), block->samples.begin(), block->samples.end());
  }
  EXPECT_EQ(replayed, recorded);
  EXPECT_THAT(replayed, testing::Not(IsEmpty()));
}

}  // namespace
}  // namespace eyebox::capture
