#include "capture/base/file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "capture/base/unix_file.h"
#include "tests/support/temporary_folder.h"

namespace eyebox {
namespace {

using testing::HasSubstr;

TEST(File, GivesBackWhatWasWritten) {
  const TemporaryFolder folder;
  const std::string content("a\0b\n", 4);
  ASSERT_TRUE(WriteFileAtomically(folder / "deep/er/file", content).ok());
  EXPECT_EQ(ReadWholeFile(folder / "deep/er/file").value(), content);
}

TEST(File, ReplacesTheOldContentAndLeavesNothingElse) {
  const TemporaryFolder folder;
  ASSERT_TRUE(WriteFileAtomically(folder / "file", "a longer text").ok());
  ASSERT_TRUE(WriteFileAtomically(folder / "file", "b").ok());
  EXPECT_EQ(ReadWholeFile(folder / "file").value(), "b");
  const std::filesystem::directory_iterator entries(folder.path());
  EXPECT_EQ(std::distance(begin(entries), end(entries)), 1);
}

TEST(File, ThatCannotBeWrittenLeavesNothing) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "taken");
  std::filesystem::create_directory(folder / "taken/full");
  EXPECT_FALSE(WriteFileAtomically(folder / "taken", "x").ok()) << "it is a folder";
  const std::filesystem::directory_iterator entries(folder.path());
  EXPECT_EQ(std::distance(begin(entries), end(entries)), 1);
}

TEST(File, ThatIsMissingIsNotFoundByName) {
  const absl::Status status = ReadWholeFile("no/such/file").status();
  EXPECT_TRUE(absl::IsNotFound(status));
  EXPECT_THAT(std::string(status.message()), HasSubstr("no/such/file"));
}

TEST(File, AboveTheLimitIsRefused) {
  const TemporaryFolder folder;
  ASSERT_TRUE(WriteFileAtomically(folder / "file", "12345").ok());
  EXPECT_TRUE(ReadWholeFile(folder / "file", 5).ok());
  EXPECT_TRUE(absl::IsInvalidArgument(ReadWholeFile(folder / "file", 4).status()));
}

TEST(File, AFolderIsNoFile) {
  const TemporaryFolder folder;
  EXPECT_TRUE(absl::IsInvalidArgument(ReadWholeFile(folder.path()).status()));
}

TEST(UnixFile, WritesAndReadsAtOffsets) {
  const TemporaryFolder folder;
  auto file = UnixFile::Create(folder / "file");
  ASSERT_TRUE(file.ok()) << file.status();
  ASSERT_TRUE(file->Reserve(100).ok());
  EXPECT_EQ(file->Size().value(), 100U);
  ASSERT_TRUE(file->WriteAt(50, "hello", 5).ok());
  std::string read(5, ' ');
  ASSERT_TRUE(file->ReadAt(50, read.data(), 5).ok());
  EXPECT_EQ(read, "hello");
}

TEST(UnixFile, ReadingBeyondTheEndIsDataLoss) {
  const TemporaryFolder folder;
  ASSERT_TRUE(WriteFileAtomically(folder / "file", "12345").ok());
  const auto file = UnixFile::OpenToRead(folder / "file");
  ASSERT_TRUE(file.ok());
  std::string read(4, ' ');
  const absl::Status status = file->ReadAt(3, read.data(), 4);
  EXPECT_TRUE(absl::IsDataLoss(status)) << status;
  EXPECT_THAT(std::string(status.message()), HasSubstr("byte 5"));
}

}  // namespace
}  // namespace eyebox
