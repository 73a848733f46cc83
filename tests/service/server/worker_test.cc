// Work in a process of its own: it may die in any way, and the server hears how.
#include "service/server/worker/worker_process.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include "service/server/worker/worker_link.h"
#include "tests/service/server/manual_work.h"

namespace eyebox::service {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class WorkerTest : public testing::Test {
 protected:
  absl::Status Do(const std::string& how, const Watcher& watcher = {}) {
    const Work work = MakeProcessWork({EYEBOX_WORKER_FOR_TEST}, limits_);
    Assignment assignment;
    assignment.request = RigJob(how);
    assignment.recording = folder_.path() / "recording";
    assignment.out = folder_.path();
    return work(assignment, watcher);
  }

  TemporaryFolder folder_;
  WorkerLimits limits_;
};

TEST_F(WorkerTest, ReportsProgressAndLeavesItsFiles) {
  std::vector<std::string> steps;
  Watcher watcher;
  watcher.progress = [&](const Progress& progress) { steps.push_back(progress.step); };
  const absl::Status status = Do("well", watcher);
  EXPECT_TRUE(status.ok()) << status;
  EXPECT_THAT(steps, ElementsAre("step 1", "step 2", "step 3", "step 4"));
  EXPECT_EQ(*ReadWholeFile(folder_.path() / "files"), "0 1 2 3 ")
      << "nothing that the server has open reaches a worker";
}

TEST_F(WorkerTest, StopsBeforeItsNextStepWhenAsked) {
  int reported = 0;
  Watcher watcher;
  watcher.progress = [&](const Progress&) { ++reported; };
  watcher.cancelled = [&] { return reported == 2; };
  EXPECT_TRUE(absl::IsCancelled(Do("well", watcher)));
  EXPECT_EQ(reported, 2);
}

TEST_F(WorkerTest, SaysWhatTheWorkSays) {
  const absl::Status status = Do("refuse");
  EXPECT_TRUE(absl::IsInvalidArgument(status));
  EXPECT_EQ(status.message(), "frame 3: is odd; make it even");
}

TEST_F(WorkerTest, DeathOfAWorkerIsAnErrorOfItsJob) {
  for (const char* how : {"segfault", "abort"}) {
    const absl::Status status = Do(how);
    EXPECT_TRUE(absl::IsDataLoss(status)) << how << " " << status;
    EXPECT_THAT(std::string(status.message()), HasSubstr("verify-files"));
  }
  EXPECT_TRUE(absl::IsInternal(Do("exit")));
  EXPECT_TRUE(absl::IsDataLoss(Do("nonsense")));
}

TEST_F(WorkerTest, ProcessorTimeIsLimited) {
  limits_.cpu_s = 1;
  const absl::Status status = Do("spin");
  EXPECT_TRUE(absl::IsResourceExhausted(status)) << status;
}

TEST_F(WorkerTest, MemoryIsLimited) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "sanitizers need an address space without limit";
#endif
  limits_.address_space_bytes = uint64_t{512} << 20;
  EXPECT_TRUE(absl::IsDataLoss(Do("memory")));
}

TEST_F(WorkerTest, CanReachNeitherNetworkNorPrograms) {
  const absl::Status status = Do("forbidden");
  EXPECT_TRUE(status.ok()) << status;
}

TEST_F(WorkerTest, ProgramThatIsNotThereIsSaid) {
  const Work work = MakeProcessWork({(folder_.path() / "missing").string()}, {});
  EXPECT_TRUE(absl::IsInternal(
      work({.request = RigJob("a"), .recording = folder_.path(), .out = folder_.path(), .desk = {}},
           {})));
}

TEST(WorkerLinkTest, WhatAWorkerMaySayComesBack) {
  const auto progress = DecodeWorker(EncodeProgress({0.25, "reducing"}));
  ASSERT_TRUE(progress.has_value());
  EXPECT_EQ(std::get<Progress>(*progress).fraction, 0.25);
  EXPECT_EQ(std::get<Progress>(*progress).step, "reducing");
  EXPECT_TRUE(std::holds_alternative<MayIGoOn>(*DecodeWorker(EncodeMayIGoOn())));
  const absl::Status status = absl::NotFoundError("no frames");
  EXPECT_EQ(std::get<absl::Status>(*DecodeWorker(EncodeEnd(status))), status);
}

TEST(WorkerLinkTest, AnythingElseIsRefused) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const std::string& message :
       {std::string(), std::string("X"), std::string("P"), std::string("M "), std::string("E\1"),
        EncodeProgress({nan, ""}), EncodeProgress({1.5, ""}), EncodeProgress({-0.1, ""}),
        std::string("E\x11\0\0\0", 5), std::string("E\xff\xff\xff\xff", 5),
        EncodeProgress({0.5, ""}) + std::string(9000, 'x')}) {
    EXPECT_FALSE(DecodeWorker(message).has_value()) << message.substr(0, 20);
  }
  EXPECT_FALSE(DecodeAssignment("").ok());
  EXPECT_FALSE(DecodeAssignment(std::string("\xff\xff\xff\xff", 4)).ok());
  EXPECT_FALSE(
      DecodeAssignment(
          EncodeAssignment({.request = RigJob("a"), .recording = "r", .out = "o", .desk = {}}) +
          "x")
          .ok());
  const auto assignment = DecodeAssignment(
      EncodeAssignment({.request = RigJob("a"), .recording = "r", .out = "o", .desk = {}}));
  ASSERT_TRUE(assignment.ok());
  EXPECT_EQ(assignment->request.request_id(), "a");
  EXPECT_EQ(assignment->recording, "r");
  EXPECT_EQ(assignment->out, "o");
}

}  // namespace
}  // namespace eyebox::service
