// Captures that end before their time, recordings without an end known, readers beside the writer.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <fstream>

#include "capture/recording/layout.h"
#include "capture/recording/pack.h"
#include "capture/recording/rolling.h"
#include "tests/capture/recording/recorded.h"

namespace eyebox::capture {
namespace {

using testing::ElementsAre;

class EarlyStop : public testing::Test {
 protected:
  void SetUp() override {
    auto writer = RecordingWriter::Create(path_, HeaderOf(), SystemClock());
    ASSERT_TRUE(writer.ok()) << writer.status();
    writer_ = *std::move(writer);
  }

  std::vector<int> FrameCounts(const std::filesystem::path& recording) {
    std::vector<int> counts;
    const auto reader = RecordingReader::Open(recording);
    EXPECT_TRUE(reader.ok()) << reader.status();
    if (!reader.ok()) return counts;
    for (const CaptureEntry& capture : (*reader)->Captures()) {
      int shown = 0;
      const absl::Status status = (*reader)->VisitFrames(capture, [&shown](const Frame&) {
        ++shown;
        return absl::OkStatus();
      });
      EXPECT_TRUE(status.ok()) << status;
      EXPECT_EQ(shown, capture.frame_count);
      counts.push_back(shown);
    }
    return counts;
  }

  const TemporaryFolder folder_;
  const std::filesystem::path path_ = folder_ / "recording";
  std::unique_ptr<RecordingWriter> writer_;
};

TEST_F(EarlyStop, PublishesWhatIsAcknowledged) {
  const auto capture = writer_->BeginCapture(SpecOf(4), kFrameSize);
  ASSERT_TRUE(capture.ok()) << capture.status();
  EXPECT_TRUE(absl::IsFailedPrecondition((*capture)->PublishEarly())) << "it has no frame";
  ASSERT_TRUE((*capture)->Append(FrameOf(0)).ok());
  EXPECT_TRUE(absl::IsFailedPrecondition((*capture)->PublishEarly())) << "it is unacknowledged";
  ASSERT_TRUE((*capture)->Acknowledge().ok());
  ASSERT_TRUE((*capture)->PublishEarly().ok());
  EXPECT_THAT(FrameCounts(path_), ElementsAre(1));
  EXPECT_EQ((*RecordingReader::Open(path_))->Captures()[0].spec.repeats, 4) << "as announced";
  EXPECT_TRUE(VerifyRecording(path_).ok());
  ASSERT_TRUE(PackRecording(path_, folder_ / "packed").ok());
  EXPECT_THAT(FrameCounts(folder_ / "packed"), ElementsAre(1));
}

TEST_F(EarlyStop, ARecordThatAppearsInAnEmptyRowIsFound) {
  {
    const auto capture = writer_->BeginCapture(SpecOf(2), kFrameSize);
    ASSERT_TRUE(capture.ok()) << capture.status();
    ASSERT_TRUE((*capture)->Append(FrameOf(0)).ok());
    ASSERT_TRUE((*capture)->Acknowledge().ok());
    ASSERT_TRUE((*capture)->PublishEarly().ok());
  }
  std::fstream file(CapturePath(path_, 1), std::ios::binary | std::ios::in | std::ios::out);
  std::string bytes(std::filesystem::file_size(CapturePath(path_, 1)), '\0');
  file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  const uint64_t id = 100;  // where the first record begins; the second one follows
  const size_t record = bytes.find(std::string(reinterpret_cast<const char*>(&id), sizeof(id)));
  ASSERT_NE(record, std::string::npos);
  bytes.replace(record + 120, 120, bytes.substr(record, 120));
  file.seekp(0);
  file << bytes << std::flush;
  EXPECT_TRUE(absl::IsDataLoss(VerifyRecording(path_).status()));
}

TEST_F(EarlyStop, RollingCapturesFollowEachOtherUntilTheEnd) {
  RollingCapture rolling(
      *writer_, {.spec = SpecOf(4), .frame_size = kFrameSize, .frames_per_acknowledgement = 3});
  for (int i = 0; i < 10; ++i) ASSERT_TRUE(rolling.Append(FrameOf(i)).ok());
  EXPECT_EQ(rolling.frames_acknowledged(), 8);
  EXPECT_THAT(FrameCounts(path_), ElementsAre(4, 4));
  ASSERT_TRUE(rolling.Finish().ok());
  EXPECT_EQ(rolling.frames_acknowledged(), 10);
  EXPECT_THAT(FrameCounts(path_), ElementsAre(4, 4, 2));
  EXPECT_TRUE(VerifyRecording(path_).ok());
}

TEST_F(EarlyStop, RollingThatEndsWithACaptureOrHasNoFrameAddsNone) {
  RollingCapture rolling(*writer_, {.spec = SpecOf(2), .frame_size = kFrameSize});
  ASSERT_TRUE(rolling.Finish().ok());
  for (int i = 0; i < 2; ++i) ASSERT_TRUE(rolling.Append(FrameOf(i)).ok());
  ASSERT_TRUE(rolling.Finish().ok());
  EXPECT_THAT(FrameCounts(path_), ElementsAre(2));
}

TEST_F(EarlyStop, AReaderBesideTheWriterSeesWhatIsPublished) {
  RollingCapture rolling(*writer_, {.spec = SpecOf(2), .frame_size = kFrameSize});
  std::vector<int> expected;
  for (int i = 0; i < 6; ++i) {
    ASSERT_TRUE(rolling.Append(FrameOf(i)).ok());
    if (i % 2 == 1) expected.push_back(2);
    EXPECT_EQ(FrameCounts(path_), expected);
    const auto verified = VerifyRecording(path_);
    ASSERT_TRUE(verified.ok()) << verified.status();
    EXPECT_EQ(verified->captures, static_cast<int>(expected.size()));
  }
}

// The moments between two system calls of Publish(): renamed and not named, named by half a record.
TEST_F(EarlyStop, AReaderBesideTheWriterIsNotTroubledByARecordInTheMaking) {
  {
    RollingCapture rolling(*writer_, {.spec = SpecOf(1), .frame_size = kFrameSize});
    ASSERT_TRUE(rolling.Append(FrameOf(0)).ok());
  }
  std::filesystem::copy(CapturePath(path_, 1), CapturePath(path_, 2));
  std::ofstream(ManifestPath(path_), std::ios::app | std::ios::binary) << "half a record";
  EXPECT_THAT(FrameCounts(path_), ElementsAre(1));
  EXPECT_TRUE(VerifyRecording(path_).ok());
  writer_.reset();  // nobody at work: now it is damage
  EXPECT_TRUE(absl::IsDataLoss(RecordingReader::Open(path_).status()));
}

TEST_F(EarlyStop, ASecondWriterIsRefused) {
  const absl::Status status = RecordingWriter::Resume(path_).status();
  EXPECT_TRUE(absl::IsFailedPrecondition(status)) << status;
  writer_.reset();
  EXPECT_TRUE(RecordingWriter::Resume(path_).ok());
}

}  // namespace
}  // namespace eyebox::capture
