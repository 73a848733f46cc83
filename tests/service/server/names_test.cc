#include "service/server/store/names.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>

#include "capture/base/file.h"
#include "service/server/store/beneath.h"
#include "tests/service/server/manual_work.h"

namespace eyebox::service {
namespace {

struct NameCase {
  const NameRule& rule;
  std::string name;
};

TEST(NamesTest, GoodNamesLoseTheirPrefixOnly) {
  EXPECT_EQ(*CheckName(kJobRule, "name", "jobs/000001"), "000001");
  EXPECT_EQ(*CheckName(kRecordingRule, "recording", "2024-05/left_eye.1"), "2024-05/left_eye.1");
  EXPECT_EQ(*CheckName(kArtifactRule, "artifact", "linearize.cube"), "linearize.cube");
  EXPECT_EQ(*CheckName(kCameraRule, "rig.camera_uri", "sim:rift-s-like"), "rift-s-like");
  EXPECT_EQ(*CheckName(kRequestIdRule, "request_id", std::string(64, 'a')), std::string(64, 'a'));
}

TEST(NamesTest, HostileNamesAreRefusedWithTheirField) {
  const NameCase cases[] = {
      {kRecordingRule, ""},
      {kRecordingRule, "."},
      {kRecordingRule, ".."},
      {kRecordingRule, "../other"},
      {kRecordingRule, "a/../../other"},
      {kRecordingRule, "/etc/passwd"},
      {kRecordingRule, "a//b"},
      {kRecordingRule, "a/"},
      {kRecordingRule, "a/b/c/d/e/f/g/h/i"},
      {kRecordingRule, std::string(65, 'a')},
      {kRecordingRule, std::string(1 << 20, 'a')},
      {kRecordingRule, std::string("a\0b", 3)},
      {kRecordingRule, "a\nb"},
      {kRecordingRule, "a b"},
      {kRecordingRule, "a\\b"},
      {kRecordingRule, "a%2fb"},
      {kRecordingRule, "~root"},
      {kRecordingRule, "$(reboot)"},
      {kRecordingRule, "r\xC3\xA9sultat"},
      {kArtifactRule, "a/b"},
      {kArtifactRule, ".."},
      {kJobRule, "000001"},
      {kJobRule, "jobs/"},
      {kJobRule, "jobs/../lock"},
      {kJobRule, "jobs/1/2"},
      {kJobRule, "Jobs/000001"},
      {kRigRule, "Rig"},
      {kRigRule, "rig_1"},
      {kCameraRule, "v4l2:/dev/video0"},
      {kCameraRule, "replay:../secret"},
      {kCameraRule, "sim:a/b"},
      {kRequestIdRule, ""},
      {kRequestIdRule, "a/b"},
      {kRequestIdRule, "'; drop table jobs"},
  };
  for (const NameCase& one : cases) {
    const auto checked = CheckName(one.rule, "the_field", one.name);
    ASSERT_TRUE(absl::IsInvalidArgument(checked.status())) << one.name.substr(0, 80);
    EXPECT_EQ(FieldOf(checked.status()), "the_field");
    EXPECT_THAT(std::string(checked.status().message()), testing::StartsWith("the_field: "));
    EXPECT_LT(checked.status().message().size(), 500u);
  }
}

class BeneathTest : public testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directories(data() / "rec/captures");
    ASSERT_TRUE(WriteFileAtomically(data() / "rec/captures/000001.h5", "frames").ok());
    ASSERT_TRUE(WriteFileAtomically(folder_.path() / "secret", "secret").ok());
    auto root = RootFolder::Open(data());
    ASSERT_TRUE(root.ok());
    root_.emplace(*std::move(root));
  }
  std::filesystem::path data() const { return folder_.path() / "data"; }

  TemporaryFolder folder_;
  std::optional<RootFolder> root_;
};

TEST_F(BeneathTest, FolderStaysTheSameWhateverIsRenamed) {
  const auto recording = root_->OpenFolder("rec");
  ASSERT_TRUE(recording.ok()) << recording.status();
  std::filesystem::rename(data() / "rec", data() / "moved");
  EXPECT_EQ(*ReadWholeFile(recording->Path() / "captures/000001.h5"), "frames");
}

TEST_F(BeneathTest, WhatIsNotThereIsNotFound) {
  EXPECT_TRUE(absl::IsNotFound(root_->OpenFolder("missing").status()));
  EXPECT_TRUE(absl::IsNotFound(root_->OpenFolder("rec/captures/000001.h5").status()));
}

TEST_F(BeneathTest, LinksLeadNowhere) {
  std::filesystem::create_symlink("../secret", data() / "file_link");
  std::filesystem::create_directory_symlink("rec", data() / "folder_link");
  EXPECT_TRUE(absl::IsPermissionDenied(root_->OpenFile("file_link").status()));
  EXPECT_TRUE(absl::IsPermissionDenied(root_->OpenFolder("folder_link").status()));
}

TEST_F(BeneathTest, PathsOutsideAreRefusedEvenIfANameCheckWasForgotten) {
  EXPECT_TRUE(absl::IsPermissionDenied(root_->OpenFile("../secret").status()));
  EXPECT_TRUE(absl::IsPermissionDenied(root_->OpenFile("/etc/passwd").status()));
}

TEST_F(BeneathTest, RecordingThatHoldsALinkOrAFifoIsRefused) {
  std::filesystem::create_symlink("../../../secret", data() / "rec/captures/000002.h5");
  EXPECT_TRUE(absl::IsPermissionDenied(root_->OpenFolder("rec").status()));
  std::filesystem::remove(data() / "rec/captures/000002.h5");
  ASSERT_EQ(mkfifo((data() / "rec/captures/000002.h5").c_str(), 0600), 0);
  EXPECT_TRUE(absl::IsPermissionDenied(root_->OpenFolder("rec").status()));
}

}  // namespace
}  // namespace eyebox::service
