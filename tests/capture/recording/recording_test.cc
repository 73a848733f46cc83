// Writing and reading back: bit for bit, by the rules of publishing.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <string>

#include "capture/base/file.h"
#include "tests/capture/recording/recorded.h"

namespace eyebox::capture {
namespace {

using testing::HasSubstr;

class Recording : public testing::Test {
 protected:
  std::unique_ptr<RecordingWriter> Create() {
    auto writer = RecordingWriter::Create(path_, HeaderOf(), SystemClock());
    EXPECT_TRUE(writer.ok()) << writer.status();
    return *std::move(writer);
  }

  std::unique_ptr<CaptureWriter> Begin(RecordingWriter& writer, int repeats) {
    auto capture = writer.BeginCapture(SpecOf(repeats), kFrameSize);
    EXPECT_TRUE(capture.ok()) << capture.status();
    return *std::move(capture);
  }

  std::unique_ptr<RecordingReader> Open() {
    auto reader = RecordingReader::Open(path_);
    EXPECT_TRUE(reader.ok()) << reader.status();
    return *std::move(reader);
  }

  const TemporaryFolder folder_;
  const std::filesystem::path path_ = folder_ / "recording";
};

TEST_F(Recording, GivesBackWhatWasWritten) {
  Record(path_);
  const auto reader = Open();
  ASSERT_EQ(reader->Captures().size(), 2U);
  int number = 0;
  for (const CaptureEntry& capture : reader->Captures()) {
    EXPECT_EQ(capture.spec, HeaderOf().plan.captures[static_cast<size_t>(capture.number) - 1]);
    EXPECT_EQ(capture.frame_size, kFrameSize);
    EXPECT_EQ(capture.frame_count, capture.spec.repeats);
    EXPECT_FALSE(capture.packed);
    const absl::Status status = reader->VisitFrames(capture, [&number](const Frame& frame) {
      const Frame expected = FrameOf(number++);
      EXPECT_TRUE(std::ranges::equal(frame.view.pixels_dn, expected.view.pixels_dn));
      EXPECT_EQ(frame.metadata.camera_frame_id, expected.metadata.camera_frame_id);
      EXPECT_EQ(frame.metadata.monotonic_time_ns, expected.metadata.monotonic_time_ns);
      return absl::OkStatus();
    });
    EXPECT_TRUE(status.ok()) << status;
  }
  EXPECT_EQ(number, 5);
}

TEST_F(Recording, KeepsEveryFieldOfTheHeader) {
  Record(path_);
  const auto reader = Open();
  const RecordingHeader& header = reader->Header();
  const RecordingHeader expected = HeaderOf();
  EXPECT_EQ(header.origin, expected.origin);
  EXPECT_EQ(header.rig.name, expected.rig.name);
  EXPECT_EQ(header.rig.camera_uri, expected.rig.camera_uri);
  EXPECT_EQ(header.rig.seed, expected.rig.seed);
  EXPECT_EQ(header.camera.vendor, expected.camera.vendor);
  EXPECT_EQ(header.camera.sensor_size, expected.camera.sensor_size);
  EXPECT_EQ(header.camera.significant_bits, 12);
  EXPECT_EQ(header.camera.exposure_min_s, 1e-5);
  EXPECT_EQ(header.camera.pixel_format, "Mono12p");
  EXPECT_EQ(header.camera.black_level_min, -8);
  EXPECT_EQ(header.camera.black_level_max, 255.5);
  EXPECT_FALSE(header.camera.software_trigger);
  EXPECT_EQ(header.camera.trigger_lines, expected.camera.trigger_lines);
  EXPECT_TRUE(header.camera.free_run);
  ASSERT_TRUE(header.camera_settings.has_value());
  EXPECT_EQ(header.camera_settings->trigger, TriggerSource::kLine);
  EXPECT_EQ(header.camera_settings->trigger_line, "Line2");
  EXPECT_EQ(header.camera_settings->black_level, 16.25);
  EXPECT_EQ(header.geometry, expected.geometry);
  EXPECT_EQ(header.plan.captures, expected.plan.captures);
  EXPECT_EQ(header.software_version, expected.software_version);
  EXPECT_EQ(header.created_real_ns, expected.created_real_ns);
}

TEST_F(Recording, TellsWhatIsUnknownFromWhatIsZero) {
  Frame known = FrameOf(0);
  known.metadata.device_time_ns = 0;
  known.metadata.trigger_time_ns = -5;
  known.metadata.exposure_reported_s = 0.0125;
  known.metadata.gain_reported_db = 0;
  known.metadata.black_level_dn = 64;
  known.metadata.temperature_degC = -1.5;
  known.metadata.photodiode_counts = 0;
  {
    const auto writer = Create();
    const auto capture = Begin(*writer, 2);
    ASSERT_TRUE(capture->Append(known).ok());
    ASSERT_TRUE(capture->Append(FrameOf(1)).ok());
    ASSERT_TRUE(capture->Acknowledge().ok());
    ASSERT_TRUE(capture->Publish().ok());
  }
  const auto reader = Open();
  std::vector<FrameMetadata> read;
  ASSERT_TRUE(reader
                  ->VisitFrames(reader->Captures()[0],
                                [&read](const Frame& frame) {
                                  read.push_back(frame.metadata);
                                  return absl::OkStatus();
                                })
                  .ok());
  ASSERT_EQ(read.size(), 2U);
  EXPECT_EQ(read[0].device_time_ns, 0);
  EXPECT_EQ(read[0].trigger_time_ns, -5);
  EXPECT_EQ(read[0].exposure_reported_s, 0.0125);
  EXPECT_EQ(read[0].gain_reported_db, 0);
  EXPECT_EQ(read[0].black_level_dn, 64);
  EXPECT_EQ(read[0].temperature_degC, -1.5);
  EXPECT_EQ(read[0].photodiode_counts, 0);
  EXPECT_FALSE(read[1].device_time_ns.has_value());
  EXPECT_FALSE(read[1].trigger_time_ns.has_value());
  EXPECT_FALSE(read[1].exposure_reported_s.has_value());
  EXPECT_FALSE(read[1].gain_reported_db.has_value());
  EXPECT_FALSE(read[1].black_level_dn.has_value());
  EXPECT_FALSE(read[1].temperature_degC.has_value());
  EXPECT_FALSE(read[1].photodiode_counts.has_value());
}

TEST_F(Recording, RefusesAFrameThatIsNotComplete) {
  const auto writer = Create();
  const auto capture = Begin(*writer, 1);
  Frame frame = FrameOf(0);
  frame.metadata.status = BufferStatus::kMissingPackets;
  EXPECT_TRUE(absl::IsFailedPrecondition(capture->Append(frame)));
  EXPECT_TRUE(capture->Append(FrameOf(0)).ok()) << "a whole one still fits";
}

TEST_F(Recording, RefusesAFrameOfAnotherSizeAndOneTooMany) {
  const auto writer = Create();
  const auto capture = Begin(*writer, 1);
  const absl::Status size = capture->Append(FrameOf(0, {.width_px = 5, .height_px = 7}));
  EXPECT_TRUE(absl::IsInvalidArgument(size));
  EXPECT_THAT(std::string(size.message()), HasSubstr("5 x 7"));
  ASSERT_TRUE(capture->Append(FrameOf(0)).ok());
  EXPECT_TRUE(absl::IsInvalidArgument(capture->Append(FrameOf(1))));
}

TEST_F(Recording, PublishesOnlyWhatIsWholeAndAcknowledged) {
  const auto writer = Create();
  const auto capture = Begin(*writer, 2);
  ASSERT_TRUE(capture->Append(FrameOf(0)).ok());
  ASSERT_TRUE(capture->Acknowledge().ok());
  EXPECT_TRUE(absl::IsFailedPrecondition(capture->Publish())) << "a frame is missing";
  ASSERT_TRUE(capture->Append(FrameOf(1)).ok());
  EXPECT_TRUE(absl::IsFailedPrecondition(capture->Publish())) << "a frame is not acknowledged";
  EXPECT_TRUE(std::filesystem::exists(path_ / "captures/000001.h5.partial"));
  EXPECT_FALSE(std::filesystem::exists(path_ / "captures/000001.h5"));
  ASSERT_TRUE(capture->Acknowledge().ok());
  EXPECT_TRUE(capture->Publish().ok());
  EXPECT_FALSE(std::filesystem::exists(path_ / "captures/000001.h5.partial"));
  EXPECT_TRUE(std::filesystem::exists(path_ / "captures/000001.h5"));
  EXPECT_TRUE(absl::IsFailedPrecondition(capture->Append(FrameOf(2)))) << "it is immutable";
}

TEST_F(Recording, ACaptureThatIsTakenAgainKeepsItsNumber) {
  const auto writer = Create();
  {
    const auto spoilt = Begin(*writer, 4);
    ASSERT_TRUE(spoilt->Append(FrameOf(9)).ok());
    EXPECT_TRUE(absl::IsFailedPrecondition(writer->BeginCapture(SpecOf(1), kFrameSize).status()))
        << "one capture is open at a time";
  }
  EXPECT_TRUE(std::filesystem::exists(path_ / "captures/000001.h5.partial"));
  {
    const auto capture = Begin(*writer, 1);
    ASSERT_TRUE(capture->Append(FrameOf(0)).ok());
    ASSERT_TRUE(capture->Acknowledge().ok());
    ASSERT_TRUE(capture->Publish().ok());
  }
  const auto reader = Open();
  ASSERT_EQ(reader->Captures().size(), 1U);
  EXPECT_EQ(reader->Captures()[0].frame_count, 1);
}

TEST_F(Recording, IsReadWhileACaptureIsUnpublished) {
  Record(path_);
  std::ofstream(path_ / "captures/000003.h5.partial") << "half a file";
  EXPECT_EQ(Open()->Captures().size(), 2U);
  EXPECT_TRUE(VerifyRecording(path_).ok());
}

TEST_F(Recording, FindsAFullDiskBeforeTheFirstFrame) {
  const auto writer = Create();
  const auto capture = writer->BeginCapture(SpecOf(2'000'000'000), {60000, 60000});
  EXPECT_TRUE(absl::IsResourceExhausted(capture.status())) << capture.status();
  EXPECT_THAT(std::string(capture.status().message()), HasSubstr("are free"));
  EXPECT_TRUE(std::filesystem::is_empty(path_ / "captures"));
  EXPECT_NE(Begin(*writer, 1), nullptr) << "a smaller one still fits";
}

TEST_F(Recording, LeavesAFolderAloneThatHoldsSomething) {
  std::filesystem::create_directories(path_);
  std::ofstream(path_ / "notes.txt") << "mine";
  EXPECT_TRUE(
      absl::IsAlreadyExists(RecordingWriter::Create(path_, HeaderOf(), SystemClock()).status()));
  EXPECT_EQ(ReadWholeFile(path_ / "notes.txt").value(), "mine");
}

TEST_F(Recording, RefusesAHeaderThatCouldNotBeReadBack) {
  RecordingHeader header = HeaderOf();
  header.rig.name = "Bench 1";
  const absl::Status status = RecordingWriter::Create(path_, header, SystemClock()).status();
  EXPECT_TRUE(absl::IsInvalidArgument(status));
  EXPECT_THAT(std::string(status.message()), HasSubstr("rig name"));
  EXPECT_FALSE(std::filesystem::exists(path_));
}

TEST_F(Recording, RefusesATriggerLineWithoutItsSource) {
  RecordingHeader header = HeaderOf();
  header.camera_settings->trigger = TriggerSource::kFreeRun;
  const absl::Status status = RecordingWriter::Create(path_, header, SystemClock()).status();
  EXPECT_TRUE(absl::IsInvalidArgument(status));
  EXPECT_THAT(std::string(status.message()), HasSubstr("camera_state trigger_line"));
}

TEST_F(Recording, TheVisitorEndsTheVisit) {
  Record(path_);
  const auto reader = Open();
  int shown = 0;
  const absl::Status status = reader->VisitFrames(reader->Captures()[1], [&shown](const Frame&) {
    return ++shown == 2 ? absl::CancelledError("enough") : absl::OkStatus();
  });
  EXPECT_TRUE(absl::IsCancelled(status));
  EXPECT_EQ(shown, 2);
}

TEST_F(Recording, AFolderWithoutOneIsNotFound) {
  const absl::Status status = RecordingReader::Open(folder_.path()).status();
  EXPECT_TRUE(absl::IsNotFound(status));
  EXPECT_THAT(std::string(status.message()), HasSubstr("manifest.log"));
}

TEST_F(Recording, VerifiesAllItHolds) {
  Record(path_);
  const auto report = VerifyRecording(path_);
  ASSERT_TRUE(report.ok()) << report.status();
  EXPECT_EQ(report->captures, 2);
  EXPECT_EQ(report->frames, 5);
  EXPECT_EQ(report->bytes,
            static_cast<int64_t>(std::filesystem::file_size(path_ / "captures/000001.h5") +
                                 std::filesystem::file_size(path_ / "captures/000002.h5")));
}

}  // namespace
}  // namespace eyebox::capture
