#include "service/server/jobs/jobs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "service/server/jobs/executor.h"
#include "tests/service/server/manual_work.h"

namespace eyebox::service {
namespace {

using testing::HasSubstr;

constexpr int64_t kCreatedNs = 1'700'000'000'000'000'000;

class JobsTest : public testing::Test {
 protected:
  void Open(const JobsOptions& options = {}) {
    auto store = JobStore::Open(folder_.path());
    ASSERT_TRUE(store.ok()) << store.status();
    auto jobs = Jobs::Open(*std::move(store), work_->AsWork(), &clock_, options);
    ASSERT_TRUE(jobs.ok()) << jobs.status();
    jobs_ = *std::move(jobs);
  }
  void OpenAndStart(const JobsOptions& options = {}) {
    Open(options);
    jobs_->Start();
  }
  // What a kill leaves on the disk: the state as it was, without an orderly stop.
  void KillAndOpen(const JobsOptions& options = {}) {
    const std::filesystem::path copy = folder_.path() / "copy";
    std::filesystem::create_directory(copy);
    std::filesystem::copy(folder_.path() / "jobs", copy / "jobs",
                          std::filesystem::copy_options::recursive);
    work_->AllowAll();
    jobs_.reset();
    std::filesystem::remove_all(folder_.path() / "jobs");
    std::filesystem::rename(copy / "jobs", folder_.path() / "jobs");
    std::filesystem::remove(copy);
    work_ = std::make_unique<ManualWork>();
    Open(options);
  }
  int64_t Create(const std::string& request_id) {
    const auto job = jobs_->Create(RigJob(request_id));
    EXPECT_TRUE(job.ok()) << job.status();
    return *JobNumber("name", job->name());
  }
  v1::Job Latest(int64_t number) { return *jobs_->table().Latest(number); }

  TemporaryFolder folder_;
  ManualClock clock_{0, kCreatedNs};
  std::unique_ptr<ManualWork> work_ = std::make_unique<ManualWork>();
  std::unique_ptr<Jobs> jobs_;

  void TearDown() override {
    work_->AllowAll();
    jobs_.reset();
  }
};

TEST_F(JobsTest, JobRunsToItsEndAndPublishesItsFiles) {
  work_->AllowAll();
  OpenAndStart();
  const v1::Job job = AwaitEnd(jobs_->table(), Create("a"));
  EXPECT_EQ(job.state(), v1::JOB_STATE_SUCCEEDED);
  EXPECT_EQ(job.progress(), 1);
  EXPECT_EQ(job.attempts(), 1);
  EXPECT_EQ(job.create_time().seconds(), kCreatedNs / 1'000'000'000);
  EXPECT_TRUE(job.has_end_time());
  ASSERT_EQ(job.artifacts_size(), 2);
  EXPECT_EQ(job.artifacts(0).name(), "result.json");
  EXPECT_EQ(job.artifacts(1).name(), "uniformity.json");
}

TEST_F(JobsTest, EventsAreNumberedWithoutGapsAndProgressNeverFalls) {
  work_->AllowAll();
  OpenAndStart();
  const int64_t number = Create("a");
  const v1::Job last = AwaitEnd(jobs_->table(), number);
  // Queued, started, four steps, ended.
  EXPECT_EQ(last.last_sequence(), 3u + ManualWork::kSteps);
  double progress = 0;
  for (uint32_t sequence = 1; sequence <= last.last_sequence(); ++sequence) {
    const auto event = *jobs_->table().Event(number, sequence);
    ASSERT_TRUE(event);
    EXPECT_EQ(event->sequence(), sequence);
    EXPECT_EQ(event->job().last_sequence(), sequence);
    EXPECT_GE(event->job().progress(), progress);
    progress = event->job().progress();
  }
  EXPECT_FALSE(*jobs_->table().Event(number, last.last_sequence() + 1));
}

TEST_F(JobsTest, SameRequestGivesTheSameJob) {
  OpenAndStart();
  EXPECT_EQ(Create("a"), Create("a"));
  EXPECT_NE(Create("a"), Create("b"));
}

TEST_F(JobsTest, RequestIdOfAnotherRequestIsRefused) {
  OpenAndStart();
  Create("a");
  v1::CreateJobRequest other = RigJob("a");
  other.mutable_run()->set_hdrp_cube_size(64);
  const auto job = jobs_->Create(other);
  EXPECT_TRUE(absl::IsAlreadyExists(job.status()));
  EXPECT_THAT(std::string(job.status().message()), HasSubstr("jobs/000001"));
}

TEST_F(JobsTest, FullQueueRefusesMore) {
  OpenAndStart({.queue_limit = 1});
  Create("runs");
  work_->AwaitBegun(1);
  Create("waits");
  EXPECT_TRUE(absl::IsResourceExhausted(jobs_->Create(RigJob("too-many")).status()));
  EXPECT_TRUE(jobs_->Create(RigJob("waits")).ok());  // it is there already
}

TEST_F(JobsTest, ErrorOfTheWorkIsTheErrorOfTheJob) {
  work_->FailWith(absl::DataLossError("000001.h5: frame 3 is not what was written; import again"));
  work_->AllowAll();
  OpenAndStart();
  const v1::Job job = AwaitEnd(jobs_->table(), Create("a"));
  EXPECT_EQ(job.state(), v1::JOB_STATE_FAILED);
  EXPECT_EQ(job.error_code(), static_cast<int>(absl::StatusCode::kDataLoss));
  EXPECT_THAT(job.error_message(), HasSubstr("frame 3"));
  EXPECT_EQ(job.artifacts_size(), 0);
  EXPECT_FALSE(std::filesystem::exists(jobs_->ResultOf(1)));
}

TEST_F(JobsTest, JobThatWaitsIsCancelledAtOnceAndNeverRuns) {
  OpenAndStart();
  Create("runs");
  work_->AwaitBegun(1);
  const int64_t waits = Create("waits");
  EXPECT_EQ(jobs_->Cancel(waits)->state(), v1::JOB_STATE_CANCELLED);
  work_->AllowAll();
  AwaitEnd(jobs_->table(), 1);
  AwaitEnd(jobs_->table(), Create("after"));
  EXPECT_EQ(work_->begun(), 2);
}

TEST_F(JobsTest, JobThatRunsIsCancelledBeforeItsNextStep) {
  OpenAndStart();
  const int64_t number = Create("a");
  work_->Allow(2);
  AwaitJob(jobs_->table(), number, [](const v1::Job& job) { return job.progress() == 0.5; });
  const auto asked = jobs_->Cancel(number);
  EXPECT_EQ(asked->state(), v1::JOB_STATE_RUNNING);
  EXPECT_TRUE(asked->cancel_requested());
  work_->AllowAll();
  const v1::Job job = AwaitEnd(jobs_->table(), number);
  EXPECT_EQ(job.state(), v1::JOB_STATE_CANCELLED);
  EXPECT_EQ(job.progress(), 0.5);
  EXPECT_EQ(job.error_code(), 0);
}

TEST_F(JobsTest, CancellingTwiceIsOneEvent) {
  OpenAndStart();
  const int64_t number = Create("a");
  work_->AwaitBegun(1);
  const auto first = jobs_->Cancel(number);
  EXPECT_EQ(jobs_->Cancel(number)->last_sequence(), first->last_sequence());
}

TEST_F(JobsTest, JobThatEndedStaysAsItIsWhenCancelled) {
  work_->AllowAll();
  OpenAndStart();
  const int64_t number = Create("a");
  const v1::Job ended = AwaitEnd(jobs_->table(), number);
  EXPECT_EQ(jobs_->Cancel(number)->DebugString(), ended.DebugString());
}

TEST_F(JobsTest, UnknownJobCannotBeCancelled) {
  OpenAndStart();
  EXPECT_TRUE(absl::IsNotFound(jobs_->Cancel(7).status()));
}

TEST_F(JobsTest, OrderlyStopInterruptsAndTheNextStartRunsAgain) {
  OpenAndStart();
  const int64_t number = Create("a");
  work_->AwaitBegun(1);
  // Stop waits for the step under way; whoever hears of it lets it go on.
  std::thread stop([this] { jobs_->Stop(); });
  while (!jobs_->stopping()) std::this_thread::yield();
  work_->AllowAll();
  stop.join();
  EXPECT_EQ(Latest(number).state(), v1::JOB_STATE_QUEUED);
  EXPECT_TRUE(absl::IsUnavailable(jobs_->Create(RigJob("b")).status()));

  jobs_.reset();
  OpenAndStart();
  const v1::Job job = AwaitEnd(jobs_->table(), number);
  EXPECT_EQ(job.state(), v1::JOB_STATE_SUCCEEDED);
  EXPECT_EQ(job.attempts(), 1);
}

TEST_F(JobsTest, KilledJobRunsAgainAfterTheRestart) {
  OpenAndStart();
  const int64_t number = Create("a");
  work_->Allow(2);
  const v1::Job before =
      AwaitJob(jobs_->table(), number, [](const v1::Job& job) { return job.progress() == 0.5; });
  KillAndOpen();
  EXPECT_EQ(Latest(number).state(), v1::JOB_STATE_QUEUED);
  EXPECT_EQ(Latest(number).last_sequence(), before.last_sequence() + 1);
  jobs_->Start();
  work_->AllowAll();
  const v1::Job job = AwaitEnd(jobs_->table(), number);
  EXPECT_EQ(job.state(), v1::JOB_STATE_SUCCEEDED);
  EXPECT_EQ(job.attempts(), 2);
  EXPECT_EQ(Create("a"), number);
}

TEST_F(JobsTest, JobThatWasCancelledBeforeAKillDoesNotRunAgain) {
  OpenAndStart();
  const int64_t number = Create("a");
  work_->AwaitBegun(1);
  ASSERT_TRUE(jobs_->Cancel(number).ok());
  KillAndOpen();
  EXPECT_EQ(Latest(number).state(), v1::JOB_STATE_CANCELLED);
}

TEST_F(JobsTest, JobThatStopsTheServerEveryTimeFailsWithTheReason) {
  OpenAndStart();
  const int64_t number = Create("a");
  work_->AwaitBegun(1);
  KillAndOpen();
  jobs_->Start();
  work_->AwaitBegun(1);
  KillAndOpen({.max_attempts = 2});
  const v1::Job job = Latest(number);
  EXPECT_EQ(job.state(), v1::JOB_STATE_FAILED);
  EXPECT_THAT(job.error_message(), HasSubstr("stopped 2 times"));
}

TEST_F(JobsTest, DamagedJobIsListedAsFailedAndTheOthersRun) {
  work_->AllowAll();
  OpenAndStart();
  AwaitEnd(jobs_->table(), Create("a"));
  AwaitEnd(jobs_->table(), Create("b"));
  jobs_.reset();
  ASSERT_TRUE(WriteFileAtomically(folder_.path() / "jobs/000001/events.log", "garbage\n").ok());
  OpenAndStart();
  EXPECT_EQ(Latest(1).state(), v1::JOB_STATE_FAILED);
  EXPECT_EQ(Latest(1).error_code(), static_cast<int>(absl::StatusCode::kDataLoss));
  EXPECT_EQ(Latest(2).state(), v1::JOB_STATE_SUCCEEDED);
  EXPECT_EQ(AwaitEnd(jobs_->table(), Create("c")).name(), "jobs/000003");
}

TEST_F(JobsTest, DiskThatRefusesAnEventEndsTheJobAndTellsWhoWaits) {
  OpenAndStart();
  const int64_t number = Create("a");
  work_->AwaitBegun(1);
  // A folder where the log should be: also root cannot append to it.
  const std::filesystem::path log = folder_.path() / "jobs/000001/events.log";
  std::filesystem::remove(log);
  std::filesystem::create_directory(log);
  work_->AllowAll();
  const v1::Job job = AwaitEnd(jobs_->table(), number);
  EXPECT_EQ(job.state(), v1::JOB_STATE_FAILED);
  EXPECT_THAT(job.error_message(), HasSubstr("events.log"));
}

TEST(ExecutorTest, StopRunsWhatWasPosted) {
  std::atomic<int> ran = 0;
  Executor executor(2);
  for (int i = 0; i < 100; ++i) executor.Post([&] { ++ran; });
  executor.Stop();
  EXPECT_EQ(ran, 100);
  executor.Post([&] { ++ran; });
  EXPECT_EQ(ran, 101);
}

TEST(JobNumberTest, OnlyTheNameAsItWasGivenNamesAJob) {
  EXPECT_EQ(*JobNumber("name", "jobs/000042"), 42);
  EXPECT_EQ(*JobNumber("name", "jobs/1000000"), 1000000);
  for (const char* other : {"jobs/42", "jobs/0000042", "jobs/-00042", "jobs/000000", "jobs/a"}) {
    EXPECT_TRUE(absl::IsNotFound(JobNumber("name", other).status())) << other;
  }
  EXPECT_TRUE(absl::IsInvalidArgument(JobNumber("name", "42").status()));
}

}  // namespace
}  // namespace eyebox::service
