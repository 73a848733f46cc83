// Captures that must not be used although they are published.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "capture/recording/pack.h"
#include "capture/recording/remaining.h"
#include "tests/capture/recording/recorded.h"

namespace eyebox::capture {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

class Suspect : public testing::Test {
 protected:
  void SetUp() override {
    Record(path_);
    auto writer = RecordingWriter::Resume(path_);
    ASSERT_TRUE(writer.ok()) << writer.status();
    writer_ = *std::move(writer);
  }

  static std::vector<std::string> Reasons(const std::filesystem::path& recording) {
    const auto reader = RecordingReader::Open(recording);
    EXPECT_TRUE(reader.ok()) << reader.status();
    std::vector<std::string> reasons;
    for (const CaptureEntry& capture : (*reader)->Captures()) reasons.push_back(capture.suspect);
    return reasons;
  }

  const TemporaryFolder folder_;
  const std::filesystem::path path_ = folder_ / "recording";
  std::unique_ptr<RecordingWriter> writer_;
};

TEST_F(Suspect, CapturesAreNamedWithTheReasonAndRemainToBeTaken) {
  EXPECT_EQ(writer_->PublishedCount(), 2);
  ASSERT_TRUE(writer_->SuspectSince(2, "the headset slept").ok());
  EXPECT_THAT(Reasons(path_), ElementsAre("", "the headset slept"));
  const auto reader = *RecordingReader::Open(path_);
  const auto plan = reader->Header().plan;
  const CapturePlan remaining = RemainingCaptures(plan, reader->Captures());
  EXPECT_THAT(remaining.captures, ElementsAre(plan.captures[1]));
}

TEST_F(Suspect, CapturesVerifyAndStaySuspectWhenPacked) {
  ASSERT_TRUE(writer_->SuspectSince(1, "dimmed").ok());
  ASSERT_TRUE(VerifyRecording(path_).ok());
  ASSERT_TRUE(PackRecording(path_, folder_ / "packed").ok());
  EXPECT_THAT(Reasons(folder_ / "packed"), ElementsAre("dimmed", "dimmed"));
}

TEST_F(Suspect, WhatIsTakenAfterwardsIsNotSuspect) {
  ASSERT_TRUE(writer_->SuspectSince(1, "dimmed").ok());
  {
    const auto capture = writer_->BeginCapture(SpecOf(1), kFrameSize);
    ASSERT_TRUE(capture.ok());
    ASSERT_TRUE((*capture)->Append(FrameOf(7)).ok());
    ASSERT_TRUE((*capture)->Acknowledge().ok());
    EXPECT_TRUE(absl::IsFailedPrecondition(writer_->SuspectSince(1, "too early")));
    ASSERT_TRUE((*capture)->Publish().ok());
  }
  EXPECT_THAT(Reasons(path_), ElementsAre("dimmed", "dimmed", IsEmpty()));
}

TEST_F(Suspect, NoCaptureOrNoReasonIsRefused) {
  EXPECT_TRUE(absl::IsInvalidArgument(writer_->SuspectSince(3, "not there")));
  EXPECT_TRUE(absl::IsInvalidArgument(writer_->SuspectSince(0, "not there")));
  EXPECT_TRUE(absl::IsInvalidArgument(writer_->SuspectSince(1, "")));
}

TEST_F(Suspect, TheRoleOfACaptureIsKept) {
  CaptureSpec reference = SpecOf(1);
  reference.role = CaptureRole::kReference;
  {
    const auto capture = writer_->BeginCapture(reference, kFrameSize);
    ASSERT_TRUE(capture.ok());
    ASSERT_TRUE((*capture)->Append(FrameOf(7)).ok());
    ASSERT_TRUE((*capture)->Acknowledge().ok());
    ASSERT_TRUE((*capture)->Publish().ok());
  }
  const auto reader = *RecordingReader::Open(path_);
  EXPECT_EQ(reader->Captures()[2].spec, reference);
  EXPECT_EQ(reader->Captures()[1].spec.role, CaptureRole::kMeasurement);
}

}  // namespace
}  // namespace eyebox::capture
