#include "capture/recording/pack.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "capture/base/file.h"
#include "tests/capture/recording/recorded.h"

namespace eyebox::capture {
namespace {

std::vector<Frame> Frames(RecordingReader& reader) {
  std::vector<Frame> frames;
  for (const CaptureEntry& capture : reader.Captures()) {
    const absl::Status status = reader.VisitFrames(capture, [&frames](const Frame& frame) {
      auto counts_dn = std::make_shared<std::vector<uint16_t>>(frame.view.pixels_dn.begin(),
                                                               frame.view.pixels_dn.end());
      frames.push_back({frame.metadata, {*counts_dn, frame.view.size}, counts_dn});
      return absl::OkStatus();
    });
    EXPECT_TRUE(status.ok()) << status;
  }
  return frames;
}

class Pack : public testing::Test {
 protected:
  void SetUp() override { Record(plain_); }
  const TemporaryFolder folder_;
  const std::filesystem::path plain_ = folder_ / "plain";
  const std::filesystem::path packed_ = folder_ / "packed";
};

TEST_F(Pack, KeepsHeaderFramesAndRecords) {
  const auto report = PackRecording(plain_, packed_);
  ASSERT_TRUE(report.ok()) << report.status();
  EXPECT_EQ(report->captures, 2);
  EXPECT_EQ(report->frames, 5);
  const auto plain = RecordingReader::Open(plain_);
  const auto packed = RecordingReader::Open(packed_);
  ASSERT_TRUE(plain.ok() && packed.ok()) << packed.status();
  EXPECT_EQ(ReadWholeFile(plain_ / "recording.textproto").value(),
            ReadWholeFile(packed_ / "recording.textproto").value());
  const std::vector<Frame> before = Frames(**plain);
  const std::vector<Frame> after = Frames(**packed);
  ASSERT_EQ(after.size(), before.size());
  for (size_t i = 0; i < after.size(); ++i) {
    EXPECT_TRUE(std::ranges::equal(after[i].view.pixels_dn, before[i].view.pixels_dn));
    EXPECT_EQ(after[i].metadata.camera_frame_id, before[i].metadata.camera_frame_id);
    EXPECT_EQ(after[i].metadata.monotonic_time_ns, before[i].metadata.monotonic_time_ns);
  }
  for (const CaptureEntry& capture : (*packed)->Captures()) EXPECT_TRUE(capture.packed);
}

TEST_F(Pack, MakesFramesOfFewBitsSmaller) {
  constexpr ImageSize kLarge = {.width_px = 300, .height_px = 200};
  const std::filesystem::path large = folder_ / "large";
  {
    auto writer = RecordingWriter::Create(large, HeaderOf(), SystemClock());
    ASSERT_TRUE(writer.ok()) << writer.status();
    auto capture = (*writer)->BeginCapture(SpecOf(1), kLarge);
    ASSERT_TRUE(capture.ok()) << capture.status();
    const std::vector<uint16_t> flat(kLarge.PixelCount(), 900);
    Frame frame;
    frame.view = {.pixels_dn = flat, .size = kLarge};
    ASSERT_TRUE((*capture)->Append(frame).ok());
    ASSERT_TRUE((*capture)->Acknowledge().ok());
    ASSERT_TRUE((*capture)->Publish().ok());
  }
  const auto report = PackRecording(large, packed_);
  ASSERT_TRUE(report.ok()) << report.status();
  EXPECT_LT(report->bytes_after, report->bytes_before / 5);
  EXPECT_TRUE(VerifyRecording(packed_).ok());
}

TEST_F(Pack, PacksThePackedOnceMore) {
  ASSERT_TRUE(PackRecording(plain_, packed_).ok());
  const auto report = PackRecording(packed_, folder_ / "again");
  ASSERT_TRUE(report.ok()) << report.status();
  EXPECT_EQ(report->bytes_after, report->bytes_before);
}

TEST_F(Pack, LeavesNothingBehindWhenTheRecordingIsDamaged) {
  std::string content = ReadWholeFile(plain_ / "captures/000002.h5").value();
  content.back() = static_cast<char>(content.back() ^ 1);
  ASSERT_TRUE(WriteFileAtomically(plain_ / "captures/000002.h5", content).ok());
  EXPECT_TRUE(absl::IsDataLoss(PackRecording(plain_, packed_).status()));
  std::vector<std::string> left;
  for (const auto& entry : std::filesystem::directory_iterator(folder_.path())) {
    left.push_back(entry.path().filename().string());
  }
  EXPECT_THAT(left, testing::ElementsAre("plain"));
}

TEST_F(Pack, DoesNotOverwrite) {
  EXPECT_TRUE(absl::IsAlreadyExists(PackRecording(plain_, plain_).status()));
  EXPECT_TRUE(VerifyRecording(plain_).ok());
}

}  // namespace
}  // namespace eyebox::capture
