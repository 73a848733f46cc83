// WatchJob and WaitJob over the socket.
#include <gmock/gmock.h>

#include <thread>

#include "tests/service/server/server_fixture.h"

namespace eyebox::service {
namespace {

using grpc::StatusCode;

class WatchCallsTest : public ServerFixture {
 protected:
  struct Watch {
    CallContext context;
    std::unique_ptr<grpc::ClientReader<v1::JobEvent>> reader;
  };
  std::unique_ptr<Watch> Start(const std::string& name, uint32_t from = 0) {
    auto watch = std::make_unique<Watch>();
    v1::WatchJobRequest request;
    request.set_name(name);
    request.set_from_sequence(from);
    watch->reader = stub_->WatchJob(&watch->context, request);
    return watch;
  }
  // Reads to the end; the numbers must follow on `from`.
  static v1::Job ReadAll(Watch& watch, uint32_t from, grpc::Status* status) {
    v1::JobEvent event;
    v1::Job last;
    for (uint32_t expected = from; watch.reader->Read(&event); ++expected) {
      EXPECT_EQ(event.sequence(), expected);
      last = event.job();
    }
    *status = watch.reader->Finish();
    return last;
  }
};

TEST_F(WatchCallsTest, EveryEventComesOnceUntilTheJobEnds) {
  const v1::Job created = CreateOk("a");
  const auto watch = Start(created.name());
  v1::JobEvent first;
  ASSERT_TRUE(watch->reader->Read(&first));
  EXPECT_EQ(first.sequence(), 1u);
  work_.AllowAll();
  grpc::Status status;
  const v1::Job last = ReadAll(*watch, 2, &status);
  EXPECT_TRUE(status.ok()) << status.error_message();
  EXPECT_EQ(last.state(), v1::JOB_STATE_SUCCEEDED);
  EXPECT_EQ(last.last_sequence(), 3u + ManualWork::kSteps);
}

TEST_F(WatchCallsTest, WatchGoesOnFromANumberAlsoAfterARestart) {
  const v1::Job ended = RunToItsEnd("a");
  StopServer();
  StartServer();
  const auto watch = Start(ended.name(), 5);
  grpc::Status status;
  EXPECT_EQ(ReadAll(*watch, 5, &status).DebugString(), ended.DebugString());
  EXPECT_TRUE(status.ok());
}

TEST_F(WatchCallsTest, NumberBeyondTheEndIsOutOfRange) {
  const v1::Job ended = RunToItsEnd("a");
  const auto watch = Start(ended.name(), ended.last_sequence() + 1);
  EXPECT_EQ(watch->reader->Finish().error_code(), StatusCode::OUT_OF_RANGE);
}

TEST_F(WatchCallsTest, UnknownJobIsNotFound) {
  EXPECT_EQ(Start("jobs/000009")->reader->Finish().error_code(), StatusCode::NOT_FOUND);
}

TEST_F(WatchCallsTest, WatcherThatGoesAwayNeverStopsTheJob) {
  const v1::Job created = CreateOk("a");
  const auto watch = Start(created.name());
  v1::JobEvent event;
  ASSERT_TRUE(watch->reader->Read(&event));
  watch->context.TryCancel();
  EXPECT_EQ(watch->reader->Finish().error_code(), StatusCode::CANCELLED);
  work_.AllowAll();
  EXPECT_EQ(WaitOk(created.name()).state(), v1::JOB_STATE_SUCCEEDED);
}

TEST_F(WatchCallsTest, ManyWatchersOfOneJobSeeTheSame) {
  const v1::Job created = CreateOk("a");
  std::vector<std::unique_ptr<Watch>> watches;
  for (int i = 0; i < 64; ++i) watches.push_back(Start(created.name()));
  work_.AllowAll();
  for (const auto& watch : watches) {
    grpc::Status status;
    EXPECT_EQ(ReadAll(*watch, 1, &status).state(), v1::JOB_STATE_SUCCEEDED);
    EXPECT_TRUE(status.ok()) << status.error_message();
  }
}

TEST_F(WatchCallsTest, StopOfTheServerTellsWatchersAndTheJobGoesOnAfterwards) {
  const v1::Job created = CreateOk("a");
  const auto watch = Start(created.name());
  v1::JobEvent event;
  ASSERT_TRUE(watch->reader->Read(&event));
  work_.AwaitBegun(1);
  std::thread stop([this] { server_->Stop(); });
  v1::Job refused;
  grpc::Status create;
  for (int i = 0; create.error_code() != StatusCode::UNAVAILABLE; ++i) {  // the stop has begun
    create = Create(RigRun("b" + std::to_string(i)), &refused);
  }
  work_.Allow(1);
  stop.join();
  grpc::Status status;
  ReadAll(*watch, 2, &status);
  EXPECT_EQ(status.error_code(), StatusCode::UNAVAILABLE) << status.error_message();
  work_.AllowAll();
  StopServer();
  StartServer();
  EXPECT_EQ(WaitOk(created.name()).state(), v1::JOB_STATE_SUCCEEDED);
}

TEST_F(WatchCallsTest, WaitReturnsTheStateWhenItsTimeIsOver) {
  const v1::Job created = CreateOk("a");
  work_.AwaitBegun(1);
  v1::Job job;
  ASSERT_TRUE(Wait(created.name(), 0, &job).ok());
  EXPECT_EQ(job.state(), v1::JOB_STATE_RUNNING);
}

TEST_F(WatchCallsTest, WaitReturnsWhenTheJobEnds) {
  const v1::Job created = CreateOk("a");
  std::thread allow([this] {
    work_.AwaitBegun(1);
    work_.AllowAll();
  });
  EXPECT_EQ(WaitOk(created.name()).state(), v1::JOB_STATE_SUCCEEDED);
  allow.join();
  EXPECT_EQ(WaitOk(created.name()).state(), v1::JOB_STATE_SUCCEEDED);
}

TEST_F(WatchCallsTest, WaitWhoseClientGoesAwayLeavesTheJobAlone) {
  const v1::Job created = CreateOk("a");
  grpc::ClientContext context;
  context.set_deadline(std::chrono::system_clock::now() + std::chrono::milliseconds(20));
  v1::WaitJobRequest request;
  request.set_name(created.name());
  request.set_timeout_s(300);
  v1::Job job;
  EXPECT_EQ(stub_->WaitJob(&context, request, &job).error_code(), StatusCode::DEADLINE_EXCEEDED);
  work_.AllowAll();
  EXPECT_EQ(WaitOk(created.name()).state(), v1::JOB_STATE_SUCCEEDED);
}

TEST_F(WatchCallsTest, BadWaitIsSaid) {
  const v1::Job created = CreateOk("a");
  v1::Job job;
  for (const double timeout_s : {-1.0, 301.0, std::nan(""), 1e300}) {
    EXPECT_EQ(Wait(created.name(), timeout_s, &job).error_code(), StatusCode::INVALID_ARGUMENT)
        << timeout_s;
  }
  EXPECT_EQ(Wait("jobs/000009", 1, &job).error_code(), StatusCode::NOT_FOUND);
}

}  // namespace
}  // namespace eyebox::service
