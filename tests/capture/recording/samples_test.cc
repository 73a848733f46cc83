// Samples of the photodiode and clock triples beside the frames, plain, packed, after a crash.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <vector>

#include "capture/base/file.h"
#include "capture/recording/manifest.h"
#include "capture/recording/pack.h"
#include "capture/recording/recover.h"
#include "tests/capture/recording/recorded.h"

namespace eyebox::capture {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

// `count` samples from conversion `sequence` on.
SampleBlock BlockOf(uint64_t sequence, size_t count, uint64_t lost_before = 0) {
  SampleBlock block = {
      .sequence = sequence, .lost_before = lost_before, .time_uncertainty_ns = 1500};
  for (size_t i = 0; i < count; ++i) {
    const auto number = static_cast<int64_t>(sequence + i);
    block.samples.push_back({.monotonic_ns = 7'000'000'000 + 1'000'000 * number,
                             .counts = static_cast<int32_t>(40 - 7 * number)});
  }
  return block;
}

SampleBlock WithDeviceTimes(SampleBlock block) {
  for (const PhotodiodeSample& sample : block.samples) {
    block.device_time_ns.push_back(sample.monotonic_ns / 2 - 4);
  }
  return block;
}

const ClockTriple kBegin = {
    .monotonic_ns = 5, .real_ns = 1700000000000000005, .device_ns = -12, .window_ns = 60};
const ClockTriple kEnd = {
    .monotonic_ns = 905, .real_ns = 1700000000000000906, .device_ns = std::nullopt, .window_ns = 0};

const std::vector<SampleBlock> kBlocks = {BlockOf(0, 3), WithDeviceTimes(BlockOf(5, 2, 2)),
                                          BlockOf(7, 1)};

class Samples : public testing::Test {
 protected:
  void SetUp() override {
    auto writer = RecordingWriter::Create(path_, HeaderOf(), SystemClock());
    ASSERT_TRUE(writer.ok()) << writer.status();
    writer_ = *std::move(writer);
  }

  std::unique_ptr<CaptureWriter> Begin(int frames, const SideRoom& room) {
    auto capture = writer_->BeginCapture(SpecOf(frames), kFrameSize, room);
    EXPECT_TRUE(capture.ok()) << capture.status();
    return capture.ok() ? *std::move(capture) : nullptr;
  }

  // Two frames in two groups, with kBlocks and both triples.
  void RecordOne(int64_t room) {
    const auto capture = Begin(2, {.samples = room, .clock_triples = 2});
    ASSERT_TRUE(capture->AppendClockTriple(kBegin).ok());
    ASSERT_TRUE(capture->Append(FrameOf(0)).ok());
    ASSERT_TRUE(capture->AppendSamples(kBlocks[0]).ok());
    ASSERT_TRUE(capture->Acknowledge().ok());
    ASSERT_TRUE(capture->Append(FrameOf(1)).ok());
    ASSERT_TRUE(capture->AppendSamples(kBlocks[1]).ok());
    ASSERT_TRUE(capture->AppendSamples(kBlocks[2]).ok());
    ASSERT_TRUE(capture->Acknowledge().ok());
    ASSERT_TRUE(capture->AppendClockTriple(kEnd).ok());
    const absl::Status published = capture->Publish();
    ASSERT_TRUE(published.ok()) << published;
  }

  static std::vector<SampleBlock> Read(const std::filesystem::path& recording) {
    std::vector<SampleBlock> blocks;
    const auto reader = RecordingReader::Open(recording);
    EXPECT_TRUE(reader.ok()) << reader.status();
    if (!reader.ok()) return blocks;
    for (const CaptureEntry& capture : (*reader)->Captures()) {
      const absl::Status status =
          (*reader)->VisitSamples(capture, [&blocks](const SampleBlock& block) {
            blocks.push_back(block);
            return absl::OkStatus();
          });
      EXPECT_TRUE(status.ok()) << status;
    }
    return blocks;
  }

  // Of the first capture.
  static std::vector<ClockTriple> Triples(const std::filesystem::path& recording) {
    const auto reader = RecordingReader::Open(recording);
    EXPECT_TRUE(reader.ok()) << reader.status();
    if (!reader.ok()) return {};
    const auto triples = (*reader)->ClockTriples((*reader)->Captures().front());
    EXPECT_TRUE(triples.ok()) << triples.status();
    return triples.value_or(std::vector<ClockTriple>());
  }

  static void Flip(const std::filesystem::path& file, size_t at) {
    std::string content = ReadWholeFile(file).value();
    content[at] = static_cast<char>(content[at] ^ 4);
    std::fstream(file, std::ios::binary | std::ios::in | std::ios::out) << content;
  }

  SideRows RowsOfBegun() {
    const auto scan = ScanManifest(path_ / "manifest.log");
    EXPECT_TRUE(scan.ok() && scan->manifest.begun);
    return scan->manifest.begun->entry.side;
  }

  const TemporaryFolder folder_;
  const std::filesystem::path path_ = folder_ / "recording";
  std::unique_ptr<RecordingWriter> writer_;
};

TEST_F(Samples, ComeBackAsTheyWereGiven) {
  RecordOne(100);
  EXPECT_EQ(Read(path_), kBlocks);
  EXPECT_THAT(Triples(path_), ElementsAre(kBegin, kEnd));
  const auto verified = VerifyRecording(path_);
  ASSERT_TRUE(verified.ok()) << verified.status();
  EXPECT_EQ(verified->samples, 6);
  EXPECT_EQ(verified->frames, 2);
}

TEST_F(Samples, ArePackedWithTheirCapture) {
  RecordOne(5);
  const auto report = PackRecording(path_, folder_ / "packed");
  ASSERT_TRUE(report.ok()) << report.status();
  EXPECT_EQ(Read(folder_ / "packed"), Read(path_));
  EXPECT_THAT(Triples(folder_ / "packed"), ElementsAre(kBegin, kEnd));
  const auto reader = RecordingReader::Open(folder_ / "packed");
  ASSERT_TRUE(reader.ok()) << reader.status();
  EXPECT_EQ((*reader)->Captures().front().samples_lost, 1);
}

TEST_F(Samples, ThatFindNoRoomAreCounted) {
  RecordOne(4);  // the second block finds room for one of its two, the third for none
  SampleBlock cut = kBlocks[1];
  cut.samples.resize(1);
  cut.device_time_ns.resize(1);
  EXPECT_THAT(Read(path_), ElementsAre(kBlocks[0], cut));
  const auto reader = RecordingReader::Open(path_);
  ASSERT_TRUE(reader.ok()) << reader.status();
  EXPECT_EQ((*reader)->Captures().front().sample_count, 4);
  EXPECT_EQ((*reader)->Captures().front().samples_lost, 2);
}

TEST_F(Samples, FindNoRoomWhereNoneWasAskedFor) {
  const auto capture = Begin(1, {});
  ASSERT_TRUE(capture->Append(FrameOf(0)).ok());
  ASSERT_TRUE(capture->AppendSamples(BlockOf(0, 5)).ok());
  EXPECT_EQ(capture->samples_lost(), 5);
  EXPECT_TRUE(absl::IsResourceExhausted(capture->AppendClockTriple(kBegin)));
  ASSERT_TRUE(capture->Acknowledge().ok()) << "a mistake of the caller spoils nothing";
  ASSERT_TRUE(capture->Publish().ok());
  EXPECT_THAT(Read(path_), IsEmpty());
  EXPECT_THAT(Triples(path_), IsEmpty());
}

TEST_F(Samples, ABlockWithoutSamplesOrWithOtherDeviceTimesIsRefused) {
  const auto capture = Begin(1, {.samples = 10, .clock_triples = 0});
  EXPECT_TRUE(absl::IsInvalidArgument(capture->AppendSamples({})));
  SampleBlock block = WithDeviceTimes(BlockOf(0, 2));
  block.device_time_ns.pop_back();
  EXPECT_TRUE(absl::IsInvalidArgument(capture->AppendSamples(block)));
  EXPECT_TRUE(capture->AppendSamples(BlockOf(0, 2)).ok());
}

TEST_F(Samples, AskedForBelowNoneAreRefused) {
  const SideRoom room = {.samples = -1, .clock_triples = 0};
  EXPECT_TRUE(absl::IsInvalidArgument(writer_->BeginCapture(SpecOf(1), kFrameSize, room).status()));
}

TEST_F(Samples, MoreAcknowledgementsThanThereAreGroupsLoseWhatFollowsAndSaySo) {
  const auto capture = Begin(1, {.samples = 1000, .clock_triples = 0});
  ASSERT_TRUE(capture->Append(FrameOf(0)).ok());
  constexpr int kGroups = 17;  // one frame and 16 more
  for (uint64_t i = 0; i < kGroups + 3; ++i) {
    ASSERT_TRUE(capture->AppendSamples(BlockOf(i, 1)).ok());
    ASSERT_TRUE(capture->Acknowledge().ok());
  }
  ASSERT_TRUE(capture->Publish().ok());
  EXPECT_EQ(Read(path_).size(), kGroups);
  const auto reader = RecordingReader::Open(path_);
  EXPECT_EQ((*reader)->Captures().front().samples_lost, 3);
}

TEST_F(Samples, EveryFlippedByteOfThemIsFound) {
  RecordOne(6);
  const SideRows rows = ScanManifest(path_ / "manifest.log")->manifest.entries.front().side;
  const std::filesystem::path file = path_ / "captures/000001.h5";
  for (const ByteRange range : {rows.Samples(), rows.Groups(), rows.Triples()}) {
    ASSERT_GT(range.size, 0);
    for (uint64_t at = 0; at < range.size; at += 7) {
      Flip(file, range.offset + at);
      const absl::Status status = VerifyRecording(path_).status();
      EXPECT_TRUE(absl::IsDataLoss(status)) << at << ": " << status;
      EXPECT_THAT(std::string(status.message()), HasSubstr(file.string()));
      Flip(file, range.offset + at);
    }
  }
  EXPECT_TRUE(VerifyRecording(path_).ok());
}

TEST_F(Samples, StayWithACaptureThatStoppedEarly) {
  {
    const auto capture = Begin(5, {.samples = 20, .clock_triples = 1});
    ASSERT_TRUE(capture->Append(FrameOf(0)).ok());
    ASSERT_TRUE(capture->AppendSamples(kBlocks[0]).ok());
    ASSERT_TRUE(capture->Acknowledge().ok());
    ASSERT_TRUE(capture->AppendSamples(BlockOf(3, 2)).ok());
    ASSERT_TRUE(capture->AppendClockTriple(kEnd).ok());
    ASSERT_TRUE(capture->PublishEarly().ok());
  }
  EXPECT_THAT(Read(path_), ElementsAre(kBlocks[0], BlockOf(3, 2)));
  EXPECT_THAT(Triples(path_), ElementsAre(kEnd));
}

class CrashedSamples : public Samples {
 protected:
  // Two groups are acknowledged, samples of a third are written only.
  void SetUp() override {
    Samples::SetUp();
    const auto capture = Begin(4, {.samples = 20, .clock_triples = 2});
    ASSERT_TRUE(capture->AppendClockTriple(kBegin).ok());
    for (int i = 0; i < 2; ++i) {
      ASSERT_TRUE(capture->Append(FrameOf(i)).ok());
      ASSERT_TRUE(capture->AppendSamples(kBlocks[static_cast<size_t>(i)]).ok());
      ASSERT_TRUE(capture->Acknowledge().ok());
    }
    ASSERT_TRUE(capture->AppendSamples(BlockOf(7, 4)).ok());
    rows_ = RowsOfBegun();
  }

  RecoverReport Recovered() {
    writer_.reset();
    auto report = RecoverRecording(path_);
    EXPECT_TRUE(report.ok()) << report.status();
    return report.ok() ? *std::move(report) : RecoverReport{};
  }

  const std::filesystem::path partial_ = path_ / "captures/000001.h5.partial";
  SideRows rows_;
};

TEST_F(CrashedSamples, ThatWereAcknowledgedAreRecovered) {
  const RecoverReport report = Recovered();
  ASSERT_TRUE(report.capture.has_value());
  EXPECT_EQ(report.capture->samples_kept, 5);
  EXPECT_EQ(report.verified.samples, 5);
  EXPECT_THAT(report.kept_aside, IsEmpty());
  EXPECT_THAT(Read(path_), ElementsAre(kBlocks[0], kBlocks[1]));
  EXPECT_THAT(Triples(path_), ElementsAre(kBegin));
}

TEST_F(CrashedSamples, OfADamagedGroupAreLeftOutAndItsRecordKeptAside) {
  Flip(partial_, rows_.samples_offset_bytes + 8);  // in the first group
  const RecoverReport report = Recovered();
  EXPECT_EQ(report.capture->samples_kept, 2);
  EXPECT_EQ(report.capture->frames_kept, 2);
  EXPECT_EQ(report.kept_aside.size(), 1);
  EXPECT_THAT(Read(path_), ElementsAre(kBlocks[1]));
}

TEST_F(CrashedSamples, ATornTripleIsLeftOut) {
  Flip(partial_, rows_.triples_offset_bytes + 3);
  EXPECT_EQ(Recovered().kept_aside.size(), 1);
  EXPECT_THAT(Triples(path_), IsEmpty());
}

TEST_F(CrashedSamples, TheRecordingGoesOnBehindThem) {
  Recovered();
  auto resumed = RecordingWriter::Resume(path_);
  ASSERT_TRUE(resumed.ok()) << resumed.status();
  writer_ = *std::move(resumed);
  RecordOne(10);
  std::vector<SampleBlock> all = {kBlocks[0], kBlocks[1]};
  all.insert(all.end(), kBlocks.begin(), kBlocks.end());
  EXPECT_EQ(Read(path_), all);
}

}  // namespace
}  // namespace eyebox::capture
