// What a crash leaves, made by hand; tests/fault makes it with real kills.
#include "capture/recording/recover.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <vector>

#include "capture/base/file.h"
#include "capture/recording/manifest.h"
#include "capture/recording/pack.h"
#include "capture/recording/remaining.h"
#include "tests/capture/recording/recorded.h"

namespace eyebox::capture {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class Recover : public testing::Test {
 protected:
  // A third capture of 5 frames, `appended` of them written, is given up.
  void RecordAndCrash(int appended) {
    Record(path_);
    const auto writer = RecordingWriter::Resume(path_);
    ASSERT_TRUE(writer.ok()) << writer.status();
    const auto capture = (*writer)->BeginCapture(SpecOf(5, 0.5), kFrameSize);
    ASSERT_TRUE(capture.ok()) << capture.status();
    for (int i = 0; i < appended; ++i) ASSERT_TRUE((*capture)->Append(FrameOf(10 + i)).ok());
    ASSERT_TRUE((*capture)->Acknowledge().ok());
  }

  RecoverReport Recovered() {
    auto report = RecoverRecording(path_);
    EXPECT_TRUE(report.ok()) << report.status();
    return report.ok() ? *std::move(report) : RecoverReport{};
  }

  // Numbers of all frames, whose pixels must be those of FrameOf.
  std::vector<int> Frames(const std::filesystem::path& recording) {
    std::vector<int> numbers;
    const auto reader = RecordingReader::Open(recording);
    EXPECT_TRUE(reader.ok()) << reader.status();
    if (!reader.ok()) return numbers;
    for (const CaptureEntry& capture : (*reader)->Captures()) {
      const absl::Status status = (*reader)->VisitFrames(capture, [&](const Frame& frame) {
        numbers.push_back(static_cast<int>(frame.metadata.camera_frame_id) - 100);
        EXPECT_TRUE(
            std::ranges::equal(frame.view.pixels_dn, FrameOf(numbers.back()).view.pixels_dn));
        return absl::OkStatus();
      });
      EXPECT_TRUE(status.ok()) << status;
    }
    return numbers;
  }

  void Flip(const std::string& name, size_t at) {
    std::string content = ReadWholeFile(path_ / name).value();
    content[at] = static_cast<char>(content[at] ^ 1);
    std::fstream(path_ / name, std::ios::binary | std::ios::in | std::ios::out) << content;
  }

  size_t PixelsOf(const std::string& name, int number) {
    const Frame frame = FrameOf(number);
    return ReadWholeFile(path_ / name)
        .value()
        .find(std::string(reinterpret_cast<const char*>(frame.view.pixels_dn.data()),
                          frame.view.pixels_dn.size_bytes()));
  }

  size_t ManifestSize() { return std::filesystem::file_size(path_ / "manifest.log"); }
  void CutManifest(size_t size) { std::filesystem::resize_file(path_ / "manifest.log", size); }

  const TemporaryFolder folder_;
  const std::filesystem::path path_ = folder_ / "recording";
  const std::string partial_ = "captures/000003.h5.partial";
};

TEST_F(Recover, LeavesASoundRecordingAsItIs) {
  Record(path_);
  const std::string manifest = ReadWholeFile(path_ / "manifest.log").value();
  const RecoverReport report = Recovered();
  EXPECT_EQ(report.manifest_bytes_cut, 0U);
  EXPECT_FALSE(report.capture.has_value());
  EXPECT_THAT(report.kept_aside, IsEmpty());
  EXPECT_EQ(report.verified.frames, 5);
  EXPECT_EQ(ReadWholeFile(path_ / "manifest.log").value(), manifest);
}

TEST_F(Recover, PublishesTheWholeFramesOfACaptureThatWasUnderWay) {
  RecordAndCrash(3);
  const RecoverReport report = Recovered();
  ASSERT_TRUE(report.capture.has_value());
  EXPECT_EQ(report.capture->number, 3);
  EXPECT_EQ(report.capture->frames_announced, 5);
  EXPECT_EQ(report.capture->frames_kept, 3);
  EXPECT_THAT(report.capture->damaged_rows, IsEmpty());
  EXPECT_EQ(report.verified.frames, 8);
  EXPECT_THAT(Frames(path_), ElementsAre(0, 1, 2, 3, 4, 10, 11, 12));
  EXPECT_FALSE(std::filesystem::exists(path_ / partial_));
  EXPECT_FALSE(Recovered().capture.has_value()) << "nothing is left to do";
}

TEST_F(Recover, ACaptureWithoutAFrameIsRemoved) {
  RecordAndCrash(0);
  const RecoverReport report = Recovered();
  ASSERT_TRUE(report.capture.has_value());
  EXPECT_EQ(report.capture->frames_kept, 0);
  EXPECT_FALSE(std::filesystem::exists(path_ / partial_));
  EXPECT_THAT(Frames(path_), ElementsAre(0, 1, 2, 3, 4));
}

TEST_F(Recover, KeepsTheFramesAroundADamagedOneAndReportsIt) {
  RecordAndCrash(4);
  Flip(partial_, PixelsOf(partial_, 11));
  const RecoverReport report = Recovered();
  ASSERT_TRUE(report.capture.has_value());
  EXPECT_EQ(report.capture->frames_kept, 3);
  EXPECT_THAT(report.capture->damaged_rows, ElementsAre(1));
  EXPECT_EQ(report.kept_aside.size(), 1U) << "the records as they were";
  EXPECT_THAT(Frames(path_), ElementsAre(0, 1, 2, 3, 4, 10, 12, 13));
  ASSERT_TRUE(PackRecording(path_, folder_ / "packed").ok());
  EXPECT_THAT(Frames(folder_ / "packed"), ElementsAre(0, 1, 2, 3, 4, 10, 12, 13));
}

TEST_F(Recover, DamageOutsideOfTheFramesIsNotTrusted) {
  RecordAndCrash(2);
  Flip(partial_, 9);
  const RecoverReport report = Recovered();
  ASSERT_TRUE(report.capture.has_value());
  EXPECT_THAT(report.capture->remark, HasSubstr("damaged outside of its frames"));
  EXPECT_EQ(report.capture->file, path_ / "aside/000003.h5.partial");
  EXPECT_TRUE(std::filesystem::exists(report.capture->file));
  EXPECT_THAT(Frames(path_), ElementsAre(0, 1, 2, 3, 4));
}

// Steps against every region: HDF5's own bytes, records, strings, frames.
TEST_F(Recover, AFlippedBitAnywhereCostsAtMostTheFrameThatItIsIn) {
  RecordAndCrash(4);
  std::filesystem::rename(path_, folder_ / "crashed");
  const size_t size = std::filesystem::file_size(folder_ / "crashed" / partial_);
  int frames_hit = 0;
  int structure_hit = 0;
  for (size_t at = 0; at < size; at += 61) {
    std::filesystem::remove_all(path_);
    std::filesystem::copy(folder_ / "crashed", path_, std::filesystem::copy_options::recursive);
    Flip(partial_, at);
    const RecoverReport report = Recovered();
    ASSERT_TRUE(report.capture.has_value());
    const std::vector<int> frames = Frames(path_);  // none of them false
    EXPECT_EQ(static_cast<int>(frames.size()),
              5 + (report.capture->remark.empty() ? report.capture->frames_kept : 0));
    if (!report.capture->remark.empty()) {
      ++structure_hit;
    } else {
      EXPECT_GE(report.capture->frames_kept, 3) << "byte " << at;
      if (report.capture->frames_kept == 3) ++frames_hit;
    }
  }
  EXPECT_GT(frames_hit, 0);
  EXPECT_GT(structure_hit, 0);
}

// Cut anywhere behind the record that says that capture 2 began.
TEST_F(Recover, EntersACaptureWhoseRecordIsTornOrMissing) {
  Record(path_);
  const std::string whole = ReadWholeFile(path_ / "manifest.log").value();
  size_t begun = whole.size();
  do {
    CutManifest(--begun);
  } while (!ScanManifest(path_ / "manifest.log")->rest.ok());
  for (size_t size = begun; size < whole.size(); ++size) {
    std::ofstream(path_ / "manifest.log", std::ios::binary) << whole.substr(0, size);
    const RecoverReport report = Recovered();
    EXPECT_EQ(report.manifest_bytes_cut, size - begun);
    ASSERT_TRUE(report.capture.has_value()) << "cut at " << size;
    EXPECT_TRUE(report.capture->was_renamed);
    ASSERT_EQ(ReadWholeFile(path_ / "manifest.log").value(), whole) << "cut at " << size;
  }
  EXPECT_THAT(Frames(path_), ElementsAre(0, 1, 2, 3, 4));
}

TEST_F(Recover, WhatIsCutFromTheManifestIsKept) {
  Record(path_);
  std::ofstream(path_ / "manifest.log", std::ios::app | std::ios::binary) << "torn";
  const RecoverReport report = Recovered();
  EXPECT_EQ(report.manifest_bytes_cut, 4U);
  ASSERT_EQ(report.kept_aside.size(), 1U);
  EXPECT_EQ(ReadWholeFile(report.kept_aside[0]).value(), "torn");
  EXPECT_EQ(report.verified.frames, 5);
}

TEST_F(Recover, DamageBeforeWholeRecordsIsNoTornEnd) {
  Record(path_);
  Flip("manifest.log", ManifestSize() / 2);
  const size_t size = ManifestSize();
  const absl::Status status = RecoverRecording(path_).status();
  EXPECT_TRUE(absl::IsDataLoss(status)) << status;
  EXPECT_EQ(ManifestSize(), size) << "left as it is";
}

TEST_F(Recover, ARecordingThatHasOnlyItsHeaderBecomesAnEmptyOne) {
  ASSERT_TRUE(RecordingWriter::Create(path_, HeaderOf(), SystemClock()).ok());
  for (const size_t size : {size_t{7}, size_t{0}}) {
    CutManifest(size);
    EXPECT_EQ(Recovered().verified.captures, 0);
  }
  std::filesystem::remove(path_ / "manifest.log");
  EXPECT_EQ(Recovered().verified.captures, 0);
  EXPECT_TRUE(RecordingWriter::Resume(path_).ok());
}

TEST_F(Recover, RefusesWhatIsBeingRecorded) {
  const auto writer = RecordingWriter::Create(path_, HeaderOf(), SystemClock());
  ASSERT_TRUE(writer.ok());
  const absl::Status status = RecoverRecording(path_).status();
  EXPECT_TRUE(absl::IsFailedPrecondition(status)) << status;
  EXPECT_THAT(std::string(status.message()), HasSubstr("manifest.log: is locked"));
}

TEST_F(Recover, AFolderWithoutARecordingIsNotFound) {
  const absl::Status status = RecoverRecording(folder_.path()).status();
  EXPECT_TRUE(absl::IsNotFound(status)) << status;
}

TEST_F(Recover, ComesBeforeResume) {
  RecordAndCrash(3);
  const absl::Status status = RecordingWriter::Resume(path_).status();
  EXPECT_TRUE(absl::IsFailedPrecondition(status)) << status;
  EXPECT_THAT(std::string(status.message()), HasSubstr("run eyebox recover"));
  Recovered();
  const auto writer = RecordingWriter::Resume(path_);
  ASSERT_TRUE(writer.ok()) << writer.status();
  auto capture = (*writer)->BeginCapture(SpecOf(1), kFrameSize);
  ASSERT_TRUE(capture.ok()) << capture.status();
  ASSERT_TRUE((*capture)->Append(FrameOf(20)).ok());
  ASSERT_TRUE((*capture)->Acknowledge().ok());
  ASSERT_TRUE((*capture)->Publish().ok());
  EXPECT_THAT(Frames(path_), ElementsAre(0, 1, 2, 3, 4, 10, 11, 12, 20));
  EXPECT_TRUE(VerifyRecording(path_).ok());
}

TEST_F(Recover, WhatRemainsOfAPlanIsWhatHasNoWholeCapture) {
  const auto published = [](int repeats, double drive, int frame_count) {
    CaptureEntry entry;
    entry.spec = SpecOf(repeats, drive);
    entry.frame_count = frame_count;
    return entry;
  };
  const CaptureEntry whole = published(2, 0.25, 2);
  const CaptureEntry early = published(3, 0.1, 1);
  const CapturePlan plan = {{SpecOf(2), SpecOf(3, 0.1), SpecOf(2)}};
  EXPECT_THAT(RemainingCaptures(plan, {}).captures,
              ElementsAre(SpecOf(2), SpecOf(3, 0.1), SpecOf(2)));
  EXPECT_THAT(RemainingCaptures(plan, std::vector{whole, early}).captures,
              ElementsAre(SpecOf(3, 0.1), SpecOf(2)));
  EXPECT_THAT(RemainingCaptures({{SpecOf(2)}}, std::vector{whole}).captures, IsEmpty());
}

}  // namespace
}  // namespace eyebox::capture
