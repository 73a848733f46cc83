// Recording a plan, and going on with it.
#include "service/steps/record_plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <vector>

#include "capture/base/clock.h"
#include "capture/plan.h"
#include "capture/recording/reader.h"
#include "service/steps/capture_log.h"
#include "service/steps/captures.h"
#include "tests/support/temporary_folder.h"

namespace eyebox::service {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::SizeIs;

class RecordAPlan : public testing::Test {
 protected:
  static capture::Rig Open(const std::string& uri = "sim:rift-s-like", uint64_t seed = 5) {
    auto rig = capture::OpenRig({.name = "test", .camera_uri = uri, .seed = seed}, SystemClock());
    EXPECT_TRUE(rig.ok()) << rig.status();
    return *std::move(rig);
  }

  static CapturePlan Plan() {  // d R l l R l R
    return *capture::MakeGreyPlan({.levels = 3,
                                   .exposures_s = {0.0125},
                                   .dark_repeats = 2,
                                   .flat_repeats = 0,
                                   .reference_every = 2});
  }

  // Stops when `frames` have been taken.
  static absl::StatusOr<capture::RunReport> RecordFrames(int frames,
                                                         const std::filesystem::path& to) {
    capture::Rig rig = Open();
    int asked = 0;
    return RecordPlan(rig, Plan(), to, {.cancelled = [&] { return ++asked > frames; }});
  }

  absl::StatusOr<capture::RunReport> Resume(const std::optional<CapturePlan>& plan = {}) {
    capture::Rig rig = Open();
    return ResumePlan(rig, plan, path_, {});
  }

  static std::vector<std::vector<uint16_t>> Frames(const std::filesystem::path& recording) {
    const auto reader = *capture::RecordingReader::Open(recording);
    std::vector<std::vector<uint16_t>> frames;
    for (const capture::CaptureEntry& entry : reader->Captures()) {
      EXPECT_TRUE(reader
                      ->VisitFrames(entry,
                                    [&frames](const Frame& frame) {
                                      frames.emplace_back(frame.view.pixels_dn.begin(),
                                                          frame.view.pixels_dn.end());
                                      return absl::OkStatus();
                                    })
                      .ok());
    }
    return frames;
  }

  std::vector<std::string> LogLines() const {
    std::ifstream log(CaptureLogPath(path_));
    std::vector<std::string> lines;
    for (std::string line; std::getline(log, line);) lines.push_back(line);
    return lines;
  }

  const TemporaryFolder folder_;
  const std::filesystem::path path_ = folder_ / "recording";
};

TEST_F(RecordAPlan, ResumedBetweenCapturesItHoldsWhatOneGoWouldHave) {
  const auto whole = folder_ / "whole";
  ASSERT_TRUE(RecordFrames(1000, whole).ok());
  EXPECT_TRUE(absl::IsCancelled(RecordFrames(6, path_).status()));  // 2 of the dark, 4 of R
  const auto report = Resume(Plan());
  ASSERT_TRUE(report.ok()) << report.status();
  EXPECT_EQ(report->captures, 5);
  EXPECT_EQ(Frames(path_), Frames(whole));
}

TEST_F(RecordAPlan, ResumedWithinACaptureItTakesThatAgain) {
  EXPECT_TRUE(absl::IsCancelled(RecordFrames(5, path_).status()));
  const auto report = Resume();
  ASSERT_TRUE(report.ok()) << report.status();
  EXPECT_EQ(report->captures, 6);
  EXPECT_TRUE(capture::VerifyRecording(path_).ok());
}

TEST_F(RecordAPlan, NothingIsLeftOfAWholeOne) {
  ASSERT_TRUE(RecordFrames(1000, path_).ok());
  const auto report = Resume();
  ASSERT_TRUE(report.ok()) << report.status();
  EXPECT_EQ(report->captures, 0);
}

TEST_F(RecordAPlan, AnotherPlanIsRefusedWithWhereItDiffers) {
  EXPECT_TRUE(absl::IsCancelled(RecordFrames(6, path_).status()));
  CapturePlan other = Plan();
  other.captures[3].repeats = 7;
  const absl::Status status = Resume(other).status();
  EXPECT_TRUE(absl::IsInvalidArgument(status)) << status;
  EXPECT_THAT(std::string(status.message()),
              AllOf(HasSubstr("another plan"), HasSubstr("capture 4")));
}

TEST_F(RecordAPlan, AnotherRigIsRefused) {
  EXPECT_TRUE(absl::IsCancelled(RecordFrames(6, path_).status()));
  for (auto& rig : {std::make_pair("sim:ideal", 5), std::make_pair("sim:rift-s-like", 6)}) {
    capture::Rig other = Open(rig.first, static_cast<uint64_t>(rig.second));
    const absl::Status status = ResumePlan(other, {}, path_, {}).status();
    EXPECT_TRUE(absl::IsInvalidArgument(status)) << status;
    EXPECT_THAT(std::string(status.message()), HasSubstr("begun with sim:rift-s-like, seed 5"));
  }
}

TEST_F(RecordAPlan, WhereThereIsNoRecordingNothingIsResumed) {
  EXPECT_TRUE(absl::IsNotFound(Resume().status()));
}

TEST_F(RecordAPlan, TheLogTellsOfEveryCaptureAcrossSessions) {
  capture::Rig rig = Open();
  int asked = 0;
  const Settle settle = capture::SettleOptions{};
  EXPECT_FALSE(
      RecordPlan(rig, Plan(), path_, {.cancelled = [&] { return ++asked > 20; }}, settle).ok());
  capture::Rig again = Open();
  ASSERT_TRUE(ResumePlan(again, {}, path_, {}, settle).ok());
  const std::vector<std::string> lines = LogLines();
  ASSERT_THAT(lines, SizeIs(1 + 7));
  EXPECT_THAT(lines[0], testing::StartsWith("number,kind,role,"));
  EXPECT_THAT(lines[1], testing::StartsWith("1,dark,measurement,\"\",-1,,,,0.0125,0,2,1,,,,"));
  // 8 frames of 13.5 ms lie in the window of 0.1 s.
  EXPECT_THAT(lines[2],
              AllOf(testing::StartsWith("2,light,reference,\"reference\",-1,0.5,0.5,0.5,"),
                    HasSubstr(",1,0.108000,9,1,")));
}

TEST_F(RecordAPlan, SuspectCapturesAreNoCapturesOfTheReduction) {
  ASSERT_TRUE(RecordFrames(1000, path_).ok());
  {
    const auto writer = *capture::RecordingWriter::Resume(path_);
    ASSERT_TRUE(writer->SuspectSince(6, "the headset slept").ok());
  }
  const auto reader = *capture::RecordingReader::Open(path_);
  EXPECT_THAT(CapturesOfKind(*reader, FrameKind::kLight), SizeIs(4));
  const auto report = Resume();
  ASSERT_TRUE(report.ok()) << report.status();
  EXPECT_EQ(report->captures, 2);
  EXPECT_THAT(CapturesOfKind(**capture::RecordingReader::Open(path_), FrameKind::kLight),
              SizeIs(6));
}

TEST_F(RecordAPlan, AReplayHasNoFramesToSpareForSettling) {
  ASSERT_TRUE(RecordFrames(1000, path_).ok());
  capture::Rig replay = Open("replay:" + path_.string());
  EXPECT_FALSE(MeasuresWithDevice(replay));
  const auto report = RecordPlan(replay, Plan(), folder_ / "again", {}, capture::SettleOptions{});
  ASSERT_TRUE(report.ok()) << report.status();
  EXPECT_EQ(Frames(folder_ / "again"), Frames(path_));
}

}  // namespace
}  // namespace eyebox::service
