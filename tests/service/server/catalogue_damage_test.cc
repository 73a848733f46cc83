// The catalogue's file is never the truth: whatever becomes of it, the answers are those of the
// recordings.
#include <SQLiteCpp/SQLiteCpp.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <random>
#include <string>

#include "capture/base/file.h"
#include "tests/service/server/catalogue_fixture.h"

namespace eyebox::service {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class CatalogueDamageTest : public CatalogueFixture {
 protected:
  void SetUp() override {
    CatalogueFixture::SetUp();
    WriteSmall(Data() / "a", {});
    WriteSmall(Data() / "b", {.taken = 1});
    truth_ = Page({}).SerializeAsString();
    told_.clear();
  }
  // The answer is right, and `told` says how it came about.
  void ExpectMadeAnew(const std::string& told) {
    EXPECT_EQ(Page({}).SerializeAsString(), truth_);
    ASSERT_EQ(told_.size(), 1u);
    EXPECT_THAT(told_[0], HasSubstr("made anew from 2 recordings: "));
    EXPECT_THAT(told_[0], HasSubstr(told));
    EXPECT_EQ(Page({}).SerializeAsString(), truth_);
    EXPECT_EQ(told_.size(), 1u) << "once is enough";
  }
  void Write(const std::string& bytes) {
    std::ofstream(File(), std::ios::binary | std::ios::trunc) << bytes;
  }
  void Execute(const std::string& sql) {
    SQLite::Database database(File().string(), SQLite::OPEN_READWRITE);
    database.exec(sql);
  }

  std::string truth_;
};

TEST_F(CatalogueDamageTest, FileIsInWalModeAndOfThisVersion) {
  SQLite::Database database(File().string(), SQLite::OPEN_READWRITE);
  EXPECT_EQ(database.execAndGet("PRAGMA journal_mode").getString(), "wal");
  EXPECT_EQ(database.execAndGet("PRAGMA user_version").getInt(), 1);
  EXPECT_EQ(database.execAndGet("SELECT count(*) FROM recordings").getInt(), 2);
}

TEST_F(CatalogueDamageTest, MissingFileIsMadeAnew) {
  std::filesystem::remove(File());
  ExpectMadeAnew("does not exist");
}

TEST_F(CatalogueDamageTest, GarbageIsMadeAnew) {
  Write("this is no database, and longer than the header of one: " + std::string(4096, 'x'));
  ExpectMadeAnew("file is not a database");
}

TEST_F(CatalogueDamageTest, EmptyFileIsMadeAnew) {
  Write("");
  ExpectMadeAnew("is of version 0 instead of 1");
}

TEST_F(CatalogueDamageTest, TruncatedFileIsMadeAnew) {
  const std::string bytes = *ReadWholeFile(File());
  Write(bytes.substr(0, 4096));
  EXPECT_EQ(Page({}).SerializeAsString(), truth_);
  ASSERT_EQ(told_.size(), 1u);
  EXPECT_THAT(told_[0], HasSubstr("made anew"));
}

TEST_F(CatalogueDamageTest, OtherVersionIsMadeAnew) {
  Execute("PRAGMA user_version=2");
  ExpectMadeAnew("is of version 2 instead of 1");
}

TEST_F(CatalogueDamageTest, OtherTablesAreMadeAnew) {
  Execute("ALTER TABLE recordings ADD COLUMN colour TEXT");
  ExpectMadeAnew("has other tables");
}

TEST_F(CatalogueDamageTest, TriggerIsMadeAnewAndNeverRuns) {
  Execute("CREATE TRIGGER evil AFTER INSERT ON recordings BEGIN DELETE FROM recordings; END");
  WriteSmall(Data() / "c", {});
  EXPECT_THAT(Names(), ElementsAre("a", "b", "c"));
  ASSERT_EQ(told_.size(), 1u);
  EXPECT_THAT(told_[0], HasSubstr("has other tables"));
}

TEST_F(CatalogueDamageTest, AlteredRowIsNotBelieved) {
  Execute("UPDATE recordings SET frames = 1000 WHERE name = 'recordings/a'");
  ExpectMadeAnew("not as it was written");
}

TEST_F(CatalogueDamageTest, RowsThatAreGoneComeBack) {
  Execute("DELETE FROM recordings");
  EXPECT_EQ(Page({}).SerializeAsString(), truth_);
}

TEST_F(CatalogueDamageTest, FolderInItsPlaceIsNotRemoved) {
  std::filesystem::remove(File());
  std::filesystem::create_directories(File() / "something");
  EXPECT_TRUE(absl::IsFailedPrecondition(catalogue_->List({}).status()));
  EXPECT_TRUE(std::filesystem::exists(File() / "something"));
}

TEST_F(CatalogueDamageTest, LogOfAnotherFileIsNotReadIntoIt) {
  const std::string other = State() / "other.sqlite";
  SQLite::Database database(other, SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
  database.exec("PRAGMA journal_mode=WAL; CREATE TABLE other (x); INSERT INTO other VALUES (1)");
  std::filesystem::copy_file(other + "-wal", File().string() + "-wal");
  EXPECT_EQ(Page({}).SerializeAsString(), truth_);
}

TEST_F(CatalogueDamageTest, WhatAKilledRebuildLeftIsNoHindrance) {
  for (const char* end : {".new", ".new-wal", ".new-shm", "-wal", "-journal"}) {
    std::ofstream(File().string() + end) << "left behind";
  }
  std::filesystem::remove(File());
  ExpectMadeAnew("does not exist");
}

// One flipped bit, anywhere: the answer is the truth, whether SQLite noticed or the checksums did.
TEST_F(CatalogueDamageTest, FlippedBitsNeverChangeAnAnswer) {
  const std::string whole = *ReadWholeFile(File());
  std::mt19937 random(11);
  for (int i = 0; i < 300; ++i) {
    std::string bytes = whole;
    bytes[random() % bytes.size()] ^= static_cast<char>(1 << random() % 8);
    Write(bytes);
    ASSERT_EQ(Page({}).SerializeAsString(), truth_) << i;
  }
  EXPECT_GT(told_.size(), 10u) << "some of them hit what matters";
}

// What a caller asked for is done even where the file is sound.
TEST_F(CatalogueDamageTest, RebuildReadsEverythingAgain) {
  ASSERT_TRUE(catalogue_->Rebuild("as was asked for").ok());
  EXPECT_THAT(told_, ElementsAre("catalogue made anew from 2 recordings: as was asked for"));
  EXPECT_EQ(Page({}).SerializeAsString(), truth_);
}

}  // namespace
}  // namespace eyebox::service
