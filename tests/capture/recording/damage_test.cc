// One flipped byte anywhere, a file cut short or gone: an error that names the file, never data.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <string>

#include "capture/base/file.h"
#include "capture/recording/manifest.h"
#include "capture/recording/pack.h"
#include "tests/capture/recording/recorded.h"

namespace eyebox::capture {
namespace {

using testing::HasSubstr;

class Damage : public testing::TestWithParam<bool> {  // packed or not
 protected:
  void SetUp() override {
    const std::filesystem::path plain = folder_ / "plain";
    Record(plain);
    recording_ = folder_ / "recording";
    if (GetParam()) {
      const auto report = PackRecording(plain, recording_);
      ASSERT_TRUE(report.ok()) << report.status();
    } else {
      std::filesystem::rename(plain, recording_);
    }
    ASSERT_TRUE(VerifyRecording(recording_).ok());
  }

  std::string Content(const std::string& name) { return ReadWholeFile(recording_ / name).value(); }

  void Write(const std::string& name, const std::string& content) {
    // In place: to cut a file and fill it again makes some file systems wait for the disk.
    std::fstream(recording_ / name, std::ios::binary | std::ios::in | std::ios::out) << content;
    std::filesystem::resize_file(recording_ / name, content.size());
  }

  // Replaces the file, verifies, and puts it back.
  absl::Status VerifyWith(const std::string& name, const std::string& content) {
    const std::string whole = Content(name);
    Write(name, content);
    const absl::Status status = VerifyRecording(recording_).status();
    Write(name, whole);
    return status;
  }

  void ExpectEveryFlipIsFound(const std::string& name, size_t step) {
    const std::string whole = Content(name);
    for (size_t at = 0; at < whole.size(); at += step) {
      std::string flipped = whole;
      flipped[at] = static_cast<char>(flipped[at] ^ (1 << at % 8));
      const absl::Status status = VerifyWith(name, flipped);
      ASSERT_TRUE(absl::IsDataLoss(status)) << name << ", byte " << at << ": " << status;
      ASSERT_THAT(std::string(status.message()), HasSubstr((recording_ / name).string()));
      ASSERT_THAT(std::string(status.message()), HasSubstr("; restore")) << "says what to do";
    }
  }

  const TemporaryFolder folder_;
  std::filesystem::path recording_;
};

INSTANTIATE_TEST_SUITE_P(Recordings, Damage, testing::Bool(),
                         [](const auto& test) { return test.param ? "Packed" : "Plain"; });

// Steps that are odd and small against every region: header, records, strings, frames.
TEST_P(Damage, OfAnyByteOfACaptureIsFound) {
  ExpectEveryFlipIsFound("captures/000001.h5", 23);
  ExpectEveryFlipIsFound("captures/000002.h5", 29);
}

TEST_P(Damage, OfAnyByteOfTheManifestIsFound) { ExpectEveryFlipIsFound("manifest.log", 1); }

TEST_P(Damage, OfAnyByteOfTheHeaderIsFound) { ExpectEveryFlipIsFound("recording.textproto", 3); }

TEST_P(Damage, AFileThatIsCutShortIsFound) {
  for (const char* name : {"captures/000001.h5", "recording.textproto"}) {
    const std::string whole = Content(name);
    for (const size_t length : {whole.size() - 1, whole.size() / 2, size_t{0}}) {
      const absl::Status status = VerifyWith(name, whole.substr(0, length));
      ASSERT_TRUE(absl::IsDataLoss(status)) << name << " at " << length << ": " << status;
      ASSERT_THAT(std::string(status.message()), HasSubstr(name));
    }
  }
}

// Cut between two records, the manifest is whole but does not know a file that is there.
TEST_P(Damage, AManifestThatIsCutShortIsFound) {
  const std::string whole = Content("manifest.log");
  for (size_t length = 0; length < whole.size(); ++length) {
    const absl::Status status = VerifyWith("manifest.log", whole.substr(0, length));
    ASSERT_TRUE(absl::IsDataLoss(status)) << "cut at " << length << ": " << status;
    ASSERT_THAT(std::string(status.message()), HasSubstr("manifest.log"));
  }
}

TEST_P(Damage, CapturesThatTradedPlacesAreFound) {
  const std::string first = Content("captures/000001.h5");
  const absl::Status status = VerifyWith("captures/000002.h5", first);
  EXPECT_TRUE(absl::IsDataLoss(status)) << status;
}

TEST_P(Damage, AMissingCaptureIsNamed) {
  std::filesystem::remove(recording_ / "captures/000002.h5");
  const absl::Status status = RecordingReader::Open(recording_).status();
  EXPECT_TRUE(absl::IsDataLoss(status)) << status;
  EXPECT_THAT(std::string(status.message()), HasSubstr("000002.h5: is missing"));
}

TEST_P(Damage, AMissingManifestIsNamed) {
  std::filesystem::remove(recording_ / "manifest.log");
  const absl::Status status = RecordingReader::Open(recording_).status();
  EXPECT_TRUE(absl::IsDataLoss(status)) << status;
  EXPECT_THAT(std::string(status.message()), HasSubstr("manifest.log"));
}

TEST_P(Damage, OfAFrameKeepsItFromTheVisitor) {
  std::string content = Content("captures/000002.h5");
  const Frame last = FrameOf(4);
  const std::string pixels(reinterpret_cast<const char*>(last.view.pixels_dn.data()),
                           last.view.pixels_dn.size_bytes());
  const size_t at = GetParam() ? content.size() / 2 : content.find(pixels);
  ASSERT_LT(at, content.size());
  content[at] = static_cast<char>(content[at] ^ 1);
  const auto reader = RecordingReader::Open(recording_);
  ASSERT_TRUE(reader.ok()) << reader.status();
  Write("captures/000002.h5", content);
  std::set<uint64_t> shown;
  const absl::Status status =
      (*reader)->VisitFrames((*reader)->Captures()[1], [&shown](const Frame& frame) {
        shown.insert(frame.metadata.camera_frame_id);
        return absl::OkStatus();
      });
  EXPECT_TRUE(absl::IsDataLoss(status)) << status;
  EXPECT_FALSE(shown.contains(104));
  const char* place = GetParam() ? "000002.h5" : "000002.h5, frame 2";
  EXPECT_THAT(std::string(status.message()), HasSubstr(place));
}

// Their product is 2^64 and a little: small, if one multiplies.
TEST(Manifest, SizesWhoseProductWrapsAreRefused) {
  const TemporaryFolder folder;
  ManifestEntry entry;
  entry.number = 1;
  entry.spec.exposure_s = 0.01;
  entry.spec.repeats = 1;
  entry.frame_size = {1 << 30, 1 << 30};
  entry.frame_count = entry.row_count = 8;
  entry.file_bytes = 1 << 20;
  {
    auto log = ManifestLog::Create(folder / "manifest.log", "header");
    ASSERT_TRUE(log.ok()) << log.status();
    ASSERT_TRUE(log->Append(entry).ok());
  }
  const auto manifest = ReadManifest(folder / "manifest.log");
  ASSERT_TRUE(absl::IsDataLoss(manifest.status())) << manifest.status();
  EXPECT_THAT(std::string(manifest.status().message()), HasSubstr("sizes that cannot be"));
}

}  // namespace
}  // namespace eyebox::capture
