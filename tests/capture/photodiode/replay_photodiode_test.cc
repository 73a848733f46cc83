#include "capture/photodiode/replay/replay_photodiode.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "capture/base/file.h"
#include "capture/recording/writer.h"

namespace eyebox::capture {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class ReplayPhotodiode : public testing::Test {
 protected:
  void SetUp() override {
    const auto* const test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::path(testing::TempDir()) / "replay_photodiode" / test->name();
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  absl::StatusOr<std::unique_ptr<Photodiode>> Open(std::string_view csv) {
    EXPECT_TRUE(WriteFileAtomically(folder_ / "photodiode.csv", csv).ok());
    return OpenPhotodiode({.uri = "replay:" + folder_.string()}, &clock_);
  }

  std::filesystem::path folder_;
  const ManualClock clock_;
};

TEST_F(ReplayPhotodiode, GivesSamplesInBlocksWithoutGaps) {
  auto photodiode = Open("monotonic_ns,counts,sequence\n100,7,0\n200,-8,1\n500,9,4\n");
  ASSERT_TRUE(photodiode.ok()) << photodiode.status();
  ASSERT_TRUE((*photodiode)->Configure({}).ok());
  ASSERT_TRUE((*photodiode)->Start().ok());
  const auto first = (*photodiode)->Read({});
  ASSERT_TRUE(first.ok());
  EXPECT_THAT(first->samples, ElementsAre(PhotodiodeSample{100, 7}, PhotodiodeSample{200, -8}));
  const auto second = (*photodiode)->Read({});
  ASSERT_TRUE(second.ok());
  EXPECT_EQ(second->sequence, 4);
  EXPECT_EQ(second->lost_before, 2);
  EXPECT_TRUE(absl::IsOutOfRange((*photodiode)->Read({}).status()));
}

TEST_F(ReplayPhotodiode, BeginsAgainAtStart) {
  auto photodiode = Open("monotonic_ns,counts\n100,7\n");
  ASSERT_TRUE(photodiode.ok()) << photodiode.status();
  ASSERT_TRUE((*photodiode)->Configure({}).ok());
  for (int i = 0; i < 2; ++i) {
    ASSERT_TRUE((*photodiode)->Start().ok());
    EXPECT_EQ((*photodiode)->Read({})->samples.size(), 1);
    ASSERT_TRUE((*photodiode)->Stop().ok());
  }
}

TEST_F(ReplayPhotodiode, LongRecordsComeInSeveralBlocks) {
  std::string csv = "monotonic_ns,counts\n";
  for (int i = 0; i < 3000; ++i) csv += std::to_string(1000 * i) + "," + std::to_string(i) + "\n";
  auto photodiode = Open(csv);
  ASSERT_TRUE(photodiode.ok()) << photodiode.status();
  ASSERT_TRUE((*photodiode)->Configure({}).ok());
  ASSERT_TRUE((*photodiode)->Start().ok());
  int32_t next = 0;
  for (auto block = (*photodiode)->Read({}); block.ok(); block = (*photodiode)->Read({})) {
    EXPECT_EQ(block->lost_before, 0);
    for (const auto& sample : block->samples) EXPECT_EQ(sample.counts, next++);
  }
  EXPECT_EQ(next, 3000);
}

TEST_F(ReplayPhotodiode, WhatIsWrongIsNamedByLine) {
  EXPECT_THAT(Open("time,counts\n1,2\n").status().message(), HasSubstr("monotonic_ns"));
  EXPECT_THAT(Open("monotonic_ns,counts\n1,2\n1,3\n").status().message(),
              HasSubstr("photodiode.csv:3: is not later"));
  EXPECT_THAT(Open("monotonic_ns,counts,sequence\n1,2,5\n2,2,5\n").status().message(),
              HasSubstr("photodiode.csv:3: repeats"));
  EXPECT_THAT(Open("monotonic_ns,counts\n1,99999999999\n").status().message(),
              HasSubstr("more than 32 bits"));
  EXPECT_TRUE(absl::IsInvalidArgument(Open("monotonic_ns,counts\n1,2.5\n").status()));
  EXPECT_TRUE(absl::IsInvalidArgument(Open("monotonic_ns,counts\n").status()));
}

TEST_F(ReplayPhotodiode, AMissingFolderIsNamed) {
  const auto photodiode = OpenPhotodiode({.uri = "replay:/nowhere/at/all"}, &clock_);
  EXPECT_TRUE(absl::IsNotFound(photodiode.status()));
  EXPECT_THAT(photodiode.status().message(), HasSubstr("/nowhere/at/all"));
}

TEST_F(ReplayPhotodiode, ARecordingWithoutSamplesIsMissingThem) {
  RecordingHeader header;
  header.rig = {.name = "test", .camera_uri = "sim:test"};
  header.camera.sensor_size = {.width_px = 4, .height_px = 3};
  header.camera.significant_bits = 12;
  const absl::Status created = RecordingWriter::Create(folder_, header, &clock_).status();
  ASSERT_TRUE(created.ok()) << created;
  const auto photodiode = OpenPhotodiode({.uri = "replay:" + folder_.string()}, &clock_);
  EXPECT_TRUE(absl::IsNotFound(photodiode.status())) << photodiode.status();
  EXPECT_THAT(std::string(photodiode.status().message()), HasSubstr("without samples"));
}

}  // namespace
}  // namespace eyebox::capture
