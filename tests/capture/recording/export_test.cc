// What is exported comes back bit for bit when it is imported.
#include "capture/recording/export.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <vector>

#include "capture/base/file.h"
#include "capture/recording/import.h"
#include "tests/capture/recording/recorded.h"

namespace eyebox::capture {
namespace {

using testing::HasSubstr;

struct Shown {
  CaptureSpec spec;
  std::vector<uint16_t> pixels_dn;
  std::optional<double> photodiode_counts;
  friend bool operator==(const Shown&, const Shown&) = default;
};

class Export : public testing::Test {
 protected:
  void Write(const std::vector<CaptureSpec>& specs) {
    const auto writer = RecordingWriter::Create(recording_, HeaderOf(), SystemClock());
    ASSERT_TRUE(writer.ok()) << writer.status();
    int number = 0;
    for (const CaptureSpec& spec : specs) {
      const auto capture = (*writer)->BeginCapture(spec, kFrameSize);
      ASSERT_TRUE(capture.ok()) << capture.status();
      for (int i = 0; i < spec.repeats; ++i) {
        Frame frame = FrameOf(number % 3);  // of 12 bits
        frame.metadata.monotonic_time_ns += number;
        if (number % 2 == 1) frame.metadata.photodiode_counts = number / 3.0;
        ASSERT_TRUE((*capture)->Append(frame).ok());
        ++number;
      }
      ASSERT_TRUE((*capture)->Acknowledge().ok());
      ASSERT_TRUE((*capture)->Publish().ok());
    }
  }

  static std::vector<Shown> Read(const std::filesystem::path& recording) {
    std::vector<Shown> all;
    const auto reader = RecordingReader::Open(recording);
    EXPECT_TRUE(reader.ok()) << reader.status();
    if (!reader.ok()) return all;
    for (const CaptureEntry& capture : (*reader)->Captures()) {
      CaptureSpec spec = capture.spec;
      spec.level_id = -1;  // a table of frames knows no plan
      const absl::Status status = (*reader)->VisitFrames(capture, [&](const Frame& frame) {
        all.push_back({spec,
                       {frame.view.pixels_dn.begin(), frame.view.pixels_dn.end()},
                       frame.metadata.photodiode_counts});
        return absl::OkStatus();
      });
      EXPECT_TRUE(status.ok()) << status;
    }
    return all;
  }

  const TemporaryFolder folder_;
  const std::filesystem::path recording_ = folder_ / "recording";
  const std::filesystem::path frames_ = folder_ / "frames";
  const std::filesystem::path again_ = folder_ / "again";
};

CaptureSpec Dark() {
  CaptureSpec spec;
  spec.kind = FrameKind::kDark;
  spec.exposure_s = 1.0 / 3;
  spec.gain_db = -1.0 / 7;
  spec.repeats = 2;
  return spec;
}

CaptureSpec FlatDisk() {
  CaptureSpec spec = SpecOf(1, 1.0 / 3);
  spec.kind = FrameKind::kFlat;
  spec.series = "a \"quoted\", named series ";
  spec.stimulus = {.pattern = StimulusPattern::kDisk, .diameter_deg = 10.0 / 3, .drive = {}};
  spec.luminance_cd_m2 = 100.0 / 3;
  spec.luminance_relative_sigma = 0.01;
  return spec;
}

TEST_F(Export, ComesBackBitForBit) {
  Write({SpecOf(2), Dark(), FlatDisk(), SpecOf(3, 0.1)});
  const auto exported = ExportTiff(recording_, frames_);
  ASSERT_TRUE(exported.ok()) << exported.status();
  EXPECT_EQ(exported->captures, 4);
  EXPECT_EQ(exported->frames, 8);
  const auto imported = ImportFolder(frames_, again_, SystemClock());
  ASSERT_TRUE(imported.ok()) << imported.status();
  EXPECT_EQ(Read(again_), Read(recording_));
  EXPECT_EQ((*RecordingReader::Open(again_))->Header().camera.significant_bits, 12);
}

TEST_F(Export, CapturesOfOneSpecificationComeBackAsOne) {
  Write({Dark(), SpecOf(1), Dark()});
  ASSERT_TRUE(ExportTiff(recording_, frames_).ok());
  const auto imported = ImportFolder(frames_, again_, SystemClock());
  ASSERT_TRUE(imported.ok()) << imported.status();
  EXPECT_EQ(imported->captures, 2);
  EXPECT_EQ(imported->frames, 5);
}

TEST_F(Export, TheTimeOfReceptionIsKept) {
  Write({SpecOf(1)});
  ASSERT_TRUE(ExportTiff(recording_, frames_).ok());
  EXPECT_THAT(ReadWholeFile(frames_ / "index.csv").value(), HasSubstr(",5.000000000,"));
}

TEST_F(Export, TakesTheKindAndSeriesThatAreAskedFor) {
  Write({SpecOf(2), Dark(), FlatDisk()});
  const auto exported = ExportTiff(recording_, frames_, {.kind = FrameKind::kDark, .series = {}});
  ASSERT_TRUE(exported.ok()) << exported.status();
  EXPECT_EQ(exported->frames, 2);
  const absl::Status none =
      ExportTiff(recording_, folder_ / "none", {.kind = {}, .series = "blue"}).status();
  EXPECT_TRUE(absl::IsNotFound(none)) << none;
  EXPECT_THAT(std::string(none.message()), HasSubstr("dark '', flat"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "none"));
}

TEST_F(Export, LeavesAFolderAloneThatHoldsSomething) {
  Write({SpecOf(1)});
  ASSERT_TRUE(ExportTiff(recording_, frames_).ok());
  EXPECT_TRUE(absl::IsAlreadyExists(ExportTiff(recording_, frames_).status()));
}

}  // namespace
}  // namespace eyebox::capture
