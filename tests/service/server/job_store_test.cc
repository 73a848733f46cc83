#include "service/server/store/job_store.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "capture/base/file.h"
#include "service/server/store/event_log.h"
#include "tests/service/server/manual_work.h"

namespace eyebox::service {
namespace {

v1::JobEvent EventNumber(uint32_t sequence, v1::JobState state) {
  v1::JobEvent event;
  event.set_sequence(sequence);
  event.mutable_job()->set_name("jobs/000001");
  event.mutable_job()->set_state(state);
  event.mutable_job()->set_last_sequence(sequence);
  return event;
}

class JobStoreTest : public testing::Test {
 protected:
  void SetUp() override { Reopen(); }
  void Reopen() {
    store_.reset();
    auto store = JobStore::Open(state());
    ASSERT_TRUE(store.ok()) << store.status();
    store_ = *std::move(store);
  }
  void CreateJob(const std::string& id) {
    ASSERT_TRUE(
        store_->Create({id, RigJob("r-" + id), {EventNumber(1, v1::JOB_STATE_QUEUED)}, {}}).ok());
  }
  std::filesystem::path state() const { return folder_.path() / "state"; }
  std::filesystem::path log() const { return state() / "jobs/000001/events.log"; }

  TemporaryFolder folder_;
  std::unique_ptr<JobStore> store_;
};

TEST_F(JobStoreTest, JobsComeBackAsTheyWereOldestFirst) {
  CreateJob("000002");
  CreateJob("000001");
  ASSERT_TRUE(store_->Append("000001", EventNumber(2, v1::JOB_STATE_RUNNING)).ok());
  Reopen();
  const auto jobs = store_->Load();
  ASSERT_TRUE(jobs.ok());
  ASSERT_EQ(jobs->size(), 2u);
  const StoredJob& first = jobs->front();
  EXPECT_EQ(first.id, "000001");
  EXPECT_EQ(first.request.DebugString(), RigJob("r-000001").DebugString());
  ASSERT_EQ(first.events.size(), 2u);
  EXPECT_EQ(first.events[1].DebugString(), EventNumber(2, v1::JOB_STATE_RUNNING).DebugString());
}

TEST_F(JobStoreTest, NewStateFolderIsClosedToOthers) {
  EXPECT_EQ(std::filesystem::status(state()).permissions() & std::filesystem::perms::others_all,
            std::filesystem::perms::none);
}

TEST_F(JobStoreTest, SecondServerOnTheSameStateIsRefused) {
  const auto second = JobStore::Open(state());
  EXPECT_TRUE(absl::IsFailedPrecondition(second.status()));
  EXPECT_THAT(std::string(second.status().message()), testing::HasSubstr("--state"));
}

TEST_F(JobStoreTest, HalfCreatedJobIsGoneAfterARestart) {
  std::filesystem::create_directories(state() / "jobs/.new");
  Reopen();
  EXPECT_TRUE(store_->Load()->empty());
  EXPECT_FALSE(std::filesystem::exists(state() / "jobs/.new"));
}

TEST_F(JobStoreTest, TornLastEventIsCutOffAndItsNumberGivenAgain) {
  CreateJob("000001");
  std::ofstream(log(), std::ios::app) << R"({"sequence":2,"job":{"na)";
  ASSERT_EQ(store_->Load()->front().events.size(), 1u);
  ASSERT_TRUE(store_->Append("000001", EventNumber(2, v1::JOB_STATE_RUNNING)).ok());
  const auto jobs = store_->Load();
  ASSERT_TRUE(jobs->front().damage.ok()) << jobs->front().damage;
  EXPECT_EQ(jobs->front().events.size(), 2u);
}

TEST_F(JobStoreTest, DamagedEventIsReportedWithItsLine) {
  CreateJob("000001");
  ASSERT_TRUE(store_->Append("000001", EventNumber(3, v1::JOB_STATE_RUNNING)).ok());
  const absl::Status damage = store_->Load()->front().damage;
  EXPECT_TRUE(absl::IsDataLoss(damage));
  EXPECT_THAT(std::string(damage.message()), testing::HasSubstr("events.log, line 2"));
}

TEST_F(JobStoreTest, ResultIsPublishedWholeWithDigests) {
  CreateJob("000001");
  ASSERT_TRUE(store_->Clear("000001").ok());
  ASSERT_TRUE(WriteFileAtomically(store_->PartialResultOf("000001") / "b.json", "").ok());
  ASSERT_TRUE(WriteFileAtomically(store_->PartialResultOf("000001") / "a.cube", "abc").ok());
  const auto artifacts = store_->PublishResult("000001");
  ASSERT_TRUE(artifacts.ok()) << artifacts.status();
  ASSERT_EQ(artifacts->size(), 2u);
  EXPECT_EQ((*artifacts)[0].name(), "a.cube");
  EXPECT_EQ((*artifacts)[0].size_bytes(), 3u);
  // FIPS 180-2, appendix B.1.
  EXPECT_EQ((*artifacts)[0].sha256(),
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(*ReadWholeFile(store_->ResultOf("000001") / "a.cube"), "abc");
  EXPECT_FALSE(std::filesystem::exists(store_->PartialResultOf("000001")));
}

TEST_F(JobStoreTest, ResultWithALinkIsNotPublished) {
  CreateJob("000001");
  ASSERT_TRUE(store_->Clear("000001").ok());
  std::filesystem::create_symlink("/etc/passwd", store_->PartialResultOf("000001") / "a.json");
  EXPECT_TRUE(absl::IsInternal(store_->PublishResult("000001").status()));
}

}  // namespace
}  // namespace eyebox::service
