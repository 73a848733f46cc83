#include "capture/recording/import.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>

#include "capture/base/file.h"
#include "tests/capture/recording/recorded.h"
#include "tests/support/grey_image.h"

namespace eyebox::capture {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr const char* kHeader = "file,kind,exposure_s,gain_db,series,repeat\n";

class Import : public testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directories(taken_);
    for (int i = 0; i < 4; ++i) {
      WriteGreyTiff(taken_ / ("f" + std::to_string(i) + ".tif"), Picture(i), 16);
    }
  }

  static Image<uint16_t> Picture(int number, ImageSize size = kFrameSize) {
    Image<uint16_t> image(size);
    std::ranges::copy(FrameOf(number % 2, size).view.pixels_dn, image.pixels().begin());
    return image;
  }

  void WriteIndex(const std::string& text) { std::ofstream(taken_ / "index.csv") << text; }

  absl::StatusOr<ImportReport> ImportTaken() { return ImportFolder(taken_, recording_, &clock_); }

  // It fails so, says all of this, and leaves no recording.
  void ExpectRefused(absl::StatusCode code, const std::vector<std::string>& words) {
    const absl::Status status = ImportTaken().status();
    EXPECT_EQ(status.code(), code) << status;
    for (const std::string& word : words) {
      EXPECT_THAT(std::string(status.message()), HasSubstr(word));
    }
    std::vector<std::string> left;
    for (const auto& entry : std::filesystem::directory_iterator(folder_.path())) {
      left.push_back(entry.path().filename().string());
    }
    EXPECT_THAT(left, ElementsAre("taken"));
  }

  const ManualClock clock_{5, 1700000000000000000};
  const TemporaryFolder folder_;
  const std::filesystem::path taken_ = folder_ / "taken";
  const std::filesystem::path recording_ = folder_ / "recording";
};

TEST_F(Import, GroupsFramesIntoCapturesInTheOrderOfRepeat) {
  WriteIndex(std::string(kHeader) +
             "f0.tif,light,0.1,0,a,2\n"
             "f1.tif,dark,0.1,0,,1\n"
             "f2.tif,light,0.2,0,a,1\n"
             "f3.tif,light,0.1,0,a,1\n");
  const auto report = ImportTaken();
  ASSERT_TRUE(report.ok()) << report.status();
  EXPECT_EQ(report->frames, 4);
  EXPECT_EQ(report->captures, 3);
  EXPECT_THAT(report->series, ElementsAre("a"));
  const auto reader = RecordingReader::Open(recording_);
  ASSERT_TRUE(reader.ok()) << reader.status();
  EXPECT_EQ((*reader)->Header().origin, RecordingOrigin::kImported);
  EXPECT_EQ((*reader)->Header().camera.significant_bits, 16);
  EXPECT_EQ((*reader)->Header().camera.exposure_min_s, 0.1);
  EXPECT_EQ((*reader)->Header().camera.exposure_max_s, 0.2);
  EXPECT_EQ((*reader)->Header().created_real_ns, 1700000000000000000);
  ASSERT_EQ((*reader)->Captures().size(), 3U);
  EXPECT_EQ((*reader)->Captures()[0].spec.exposure_s, 0.1);
  EXPECT_EQ((*reader)->Captures()[1].spec.kind, FrameKind::kDark);
  EXPECT_EQ((*reader)->Captures()[2].spec.exposure_s, 0.2);
  std::vector<uint16_t> first_dn;
  ASSERT_TRUE((*reader)
                  ->VisitFrames((*reader)->Captures()[0],
                                [&first_dn](const Frame& frame) {
                                  first_dn.push_back(frame.view.pixels_dn[0]);
                                  return absl::OkStatus();
                                })
                  .ok());
  EXPECT_THAT(first_dn, ElementsAre(1000, 0)) << "f3 is repeat 1, f0 is repeat 2";
}

TEST_F(Import, KeepsEveryColumn) {
  WriteIndex(
      "bits,file,kind,exposure_s,gain_db,series,repeat,pattern,diameter_deg,drive_r,drive_g,drive_"
      "b,"
      "luminance_cd_m2,luminance_relative_sigma,timestamp_s,photodiode_counts\n"
      "14,\"f0.tif\",light,0.1,6,\"a, b\",1,disk,2.5,0.1,0.2,0.3,12,0.02,1.5,4096.5\n");
  const auto report = ImportTaken();
  ASSERT_TRUE(report.ok()) << report.status();
  const auto reader = RecordingReader::Open(recording_);
  ASSERT_TRUE(reader.ok()) << reader.status();
  const CaptureEntry& capture = (*reader)->Captures()[0];
  EXPECT_EQ(capture.spec.series, "a, b");
  EXPECT_EQ(capture.spec.gain_db, 6);
  EXPECT_EQ(capture.spec.stimulus.pattern, StimulusPattern::kDisk);
  EXPECT_EQ(capture.spec.stimulus.diameter_deg, 2.5);
  EXPECT_EQ(capture.spec.stimulus.drive, (DriveRgb{0.1, 0.2, 0.3}));
  EXPECT_EQ(capture.spec.luminance_cd_m2, 12);
  EXPECT_EQ(capture.spec.luminance_relative_sigma, 0.02);
  EXPECT_EQ((*reader)->Header().camera.significant_bits, 14);
  const absl::Status visited = (*reader)->VisitFrames(capture, [](const Frame& frame) {
    EXPECT_EQ(frame.metadata.device_time_ns, 1500000000);
    EXPECT_EQ(frame.metadata.photodiode_counts, 4096.5);
    EXPECT_EQ(frame.metadata.exposure_asked_s, 0.1);
    EXPECT_FALSE(frame.metadata.exposure_reported_s.has_value());
    return absl::OkStatus();
  });
  EXPECT_TRUE(visited.ok()) << visited;
}

TEST_F(Import, NamesAMissingFileByLineAndColumn) {
  WriteIndex(std::string(kHeader) + "f0.tif,light,0.1,0,a,1\ngone.tif,light,0.1,0,a,2\n");
  ExpectRefused(absl::StatusCode::kNotFound, {"index.csv:3, column file", "gone.tif"});
}

TEST_F(Import, RefusesATruncatedImage) {
  const std::string whole = ReadWholeFile(taken_ / "f1.tif").value();
  std::ofstream(taken_ / "f1.tif", std::ios::binary) << whole.substr(0, whole.size() - 7);
  WriteIndex(std::string(kHeader) + "f0.tif,light,0.1,0,a,1\nf1.tif,light,0.1,0,a,2\n");
  ExpectRefused(absl::StatusCode::kDataLoss, {"f1.tif", "truncated"});
}

TEST_F(Import, RefusesImagesOfAnotherSizeOrDepth) {
  WriteGreyTiff(taken_ / "f1.tif", Picture(1, {.width_px = 5, .height_px = 7}), 16);
  WriteIndex(std::string(kHeader) + "f0.tif,light,0.1,0,a,1\nf1.tif,light,0.1,0,a,2\n");
  ExpectRefused(absl::StatusCode::kInvalidArgument, {"f1.tif", "5 x 7", "7 x 5"});
  WriteGreyTiff(taken_ / "f1.tif", Image<uint16_t>(kFrameSize, 9), 8);
  ExpectRefused(absl::StatusCode::kInvalidArgument, {"f1.tif", "8 significant bits"});
}

TEST_F(Import, RefusesCountsBeyondTheStatedBits) {
  WriteIndex("file,kind,exposure_s,gain_db,series,repeat,bits\nf1.tif,light,0.1,0,a,1,10\n");
  ExpectRefused(absl::StatusCode::kInvalidArgument, {"f1.tif", "2258 DN", "10 bits"});
}

TEST_F(Import, RefusesARepeatGivenTwice) {
  WriteIndex(std::string(kHeader) + "f0.tif,light,0.1,0,a,1\nf1.tif,light,0.1,0,a,1\n");
  ExpectRefused(absl::StatusCode::kInvalidArgument, {"index.csv:3", "index.csv:2", "repeat 1"});
}

struct BadField {
  const char* header;
  const char* row;
  const char* where;
};

class ImportOfABadField : public Import, public testing::WithParamInterface<BadField> {};

TEST_P(ImportOfABadField, IsRefusedByLineAndColumn) {
  WriteIndex(std::string(GetParam().header) + "\n" + GetParam().row + "\n");
  ExpectRefused(absl::StatusCode::kInvalidArgument, {GetParam().where});
}

constexpr const char* kColumns = "file,kind,exposure_s,gain_db,series,repeat";
constexpr const char* kWithDrive =
    "file,kind,exposure_s,gain_db,series,repeat,drive_r,drive_g,drive_b";
constexpr const char* kWithDisk = "file,kind,exposure_s,gain_db,series,repeat,pattern,diameter_deg";

INSTANTIATE_TEST_SUITE_P(
    Fields, ImportOfABadField,
    testing::Values(
        BadField{kColumns, "f0.tif,bright,0.1,0,a,1", "index.csv:2, column kind"},
        BadField{kColumns, "f0.tif,light,0,0,a,1", "index.csv:2, column exposure_s"},
        BadField{kColumns, "f0.tif,light,nan,0,a,1", "index.csv:2, column exposure_s"},
        BadField{kColumns, "f0.tif,light,0.1s,0,a,1", "index.csv:2, column exposure_s"},
        BadField{kColumns, "f0.tif,light,0.1,inf,a,1", "index.csv:2, column gain_db"},
        BadField{kColumns, "f0.tif,light,0.1,0,a,first", "index.csv:2, column repeat"},
        BadField{kColumns, "f0.tif,light,0.1,0,a", "index.csv:2"},
        BadField{kColumns, "/etc/passwd,light,0.1,0,a,1", "index.csv:2, column file"},
        BadField{"file,kind,exposure_s,gain_db,repeat", "f0.tif,light,0.1,0,1", "'series'"},
        BadField{"file,kind,exposure_s,gain_db,series,repeat,colour", "f0.tif,light,0.1,0,a,1,r",
                 "'colour'"},
        BadField{kWithDrive, "f0.tif,light,0.1,0,a,1,1.5,0,0", "index.csv:2, column drive_r"},
        BadField{kWithDrive, "f0.tif,light,0.1,0,a,1,1,,0", "index.csv:2, column drive_r"},
        BadField{kWithDisk, "f0.tif,light,0.1,0,a,1,ring,3", "index.csv:2, column pattern"},
        BadField{kWithDisk, "f0.tif,light,0.1,0,a,1,disk,", "index.csv:2, column pattern"},
        BadField{kWithDisk, "f0.tif,light,0.1,0,a,1,,3", "index.csv:2, column diameter_deg"}));

TEST_F(Import, WithoutAnIndexIsNotFound) {
  ExpectRefused(absl::StatusCode::kNotFound, {"index.csv"});
}

TEST_F(Import, DoesNotOverwrite) {
  WriteIndex(std::string(kHeader) + "f0.tif,light,0.1,0,a,1\n");
  ASSERT_TRUE(ImportTaken().ok());
  EXPECT_TRUE(absl::IsAlreadyExists(ImportTaken().status()));
  EXPECT_TRUE(VerifyRecording(recording_).ok());
}

TEST(ImportOfRealFrames, MakesACaptureOfEveryExposure) {
  const auto frames = std::filesystem::path(EYEBOX_SOURCE_DIR) / "../shared/reference/frames";
  if (!std::filesystem::exists(frames)) GTEST_SKIP() << frames << " is absent";
  const TemporaryFolder folder;
  const auto report = ImportFolder(frames, folder / "rec", SystemClock());
  ASSERT_TRUE(report.ok()) << report.status();
  EXPECT_EQ(report->frames, 28);
  EXPECT_EQ(report->captures, 21);
  EXPECT_THAT(report->series, ElementsAre("filter_550nm", "filter_650nm"));
  const auto verified = VerifyRecording(folder / "rec");
  ASSERT_TRUE(verified.ok()) << verified.status();
  EXPECT_EQ(verified->frames, 28);
}

}  // namespace
}  // namespace eyebox::capture
