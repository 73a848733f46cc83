// CreateRun, GetJob, ListJobs, CancelJob over the socket.
#include <gmock/gmock.h>

#include "tests/service/server/hostile_names.h"
#include "tests/service/server/server_fixture.h"

namespace eyebox::service {
namespace {

using grpc::StatusCode;
using testing::HasSubstr;

class RunCallsTest : public ServerFixture {
 protected:
  grpc::Status Get(const std::string& name, v1::Job* job) {
    CallContext context;
    v1::GetJobRequest request;
    request.set_name(name);
    return stub_->GetJob(&context, request, job);
  }
  grpc::Status List(int page_size, const std::string& token, v1::ListJobsResponse* page) {
    CallContext context;
    v1::ListJobsRequest request;
    request.set_page_size(page_size);
    request.set_page_token(token);
    return stub_->ListJobs(&context, request, page);
  }
  grpc::Status Cancel(const std::string& name, v1::Job* job) {
    CallContext context;
    v1::CancelJobRequest request;
    request.set_name(name);
    return stub_->CancelJob(&context, request, job);
  }
};

TEST_F(RunCallsTest, CreateReturnsAtOnceAndTheSameRequestGivesTheSameJob) {
  const v1::Job first = CreateOk("a");  // no step was allowed: the work cannot have ended
  EXPECT_EQ(first.name(), "jobs/000001");
  EXPECT_EQ(CreateOk("a").name(), first.name());
  EXPECT_EQ(CreateOk("b").name(), "jobs/000002");
}

TEST_F(RunCallsTest, SameRequestGivesTheSameJobAfterARestart) {
  const v1::Job before = RunToItsEnd("a");
  StopServer();
  StartServer();
  EXPECT_EQ(CreateOk("a").DebugString(), before.DebugString());
}

TEST_F(RunCallsTest, RequestIdOfAnotherRequestIsRefused) {
  CreateOk("a");
  v1::CreateRunRequest other = RigRun("a");
  other.mutable_rig()->set_seed(7);
  v1::Job job;
  EXPECT_EQ(Create(other, &job).error_code(), StatusCode::ALREADY_EXISTS);
}

TEST_F(RunCallsTest, WrongFieldsAreRefusedByName) {
  const auto with = [](auto change) {
    v1::CreateRunRequest request = RigRun("a");
    change(request);
    return request;
  };
  const std::pair<v1::CreateRunRequest, std::string> cases[] = {
      {with([](auto& r) { r.clear_request_id(); }), "request_id"},
      {with([](auto& r) { r.clear_rig(); }), "source"},
      {with([](auto& r) { r.set_recording("../other"); }), "recording"},
      {with([](auto& r) { r.mutable_rig()->set_name("Rig!"); }), "rig.name"},
      {with([](auto& r) { r.mutable_rig()->set_camera_uri("v4l2:/dev/video0"); }),
       "rig.camera_uri"},
      {with([](auto& r) { r.set_hdrp_cube_size(130); }), "hdrp_cube_size"},
      {with([](auto& r) { r.set_hdrp_cube_size(-1); }), "hdrp_cube_size"},
      {with([](auto& r) { r.set_pps_strip_size(33); }), "pps_strip_size"},
  };
  for (const auto& [request, field] : cases) {
    v1::Job job;
    const grpc::Status status = Create(request, &job);
    EXPECT_EQ(status.error_code(), StatusCode::INVALID_ARGUMENT) << field;
    EXPECT_EQ(ViolatedField(status), field) << status.error_message();
    EXPECT_THAT(status.error_message(), HasSubstr(field));
  }
}

TEST_F(RunCallsTest, RecordingIsLookedForBelowTheServedFolder) {
  v1::CreateRunRequest request;
  request.set_request_id("a");
  request.set_recording("missing");
  v1::Job job;
  const grpc::Status missing = Create(request, &job);
  EXPECT_EQ(missing.error_code(), StatusCode::NOT_FOUND);
  EXPECT_EQ(ViolatedField(missing), "recording");
  request.set_recording("rec");
  EXPECT_TRUE(Create(request, &job).ok());
}

TEST_F(RunCallsTest, LinkOutOfTheServedFolderIsRefused) {
  std::filesystem::create_directory_symlink("/etc", folder_.path() / "data/link");
  v1::CreateRunRequest request;
  request.set_request_id("a");
  request.set_recording("link");
  v1::Job job;
  EXPECT_EQ(Create(request, &job).error_code(), StatusCode::PERMISSION_DENIED);
}

TEST_F(RunCallsTest, FullQueueIsSaid) {
  CreateOk("runs");
  work_.AwaitBegun(1);
  for (int i = 0; i < 4; ++i) CreateOk("waits-" + std::to_string(i));
  v1::Job job;
  EXPECT_EQ(Create(RigRun("more"), &job).error_code(), StatusCode::RESOURCE_EXHAUSTED);
}

TEST_F(RunCallsTest, UnknownJobIsNotFoundAndABadNameIsSaid) {
  v1::Job job;
  EXPECT_EQ(Get("jobs/000009", &job).error_code(), StatusCode::NOT_FOUND);
  EXPECT_EQ(Cancel("jobs/000009", &job).error_code(), StatusCode::NOT_FOUND);
  const grpc::Status bad = Get("jobs/../lock", &job);
  EXPECT_EQ(bad.error_code(), StatusCode::INVALID_ARGUMENT);
  EXPECT_EQ(ViolatedField(bad), "name");
}

TEST_F(RunCallsTest, PagesHoldEveryJobOnceNewestFirst) {
  work_.AllowAll();
  for (int i = 1; i <= 5; ++i) WaitOk(CreateOk("r" + std::to_string(i)).name());
  std::vector<std::string> ids;
  std::string token;
  do {
    v1::ListJobsResponse page;
    ASSERT_TRUE(List(2, token, &page).ok());
    for (const v1::Job& job : page.jobs()) ids.push_back(job.request_id());
    token = page.next_page_token();
  } while (!token.empty());
  EXPECT_THAT(ids, testing::ElementsAre("r5", "r4", "r3", "r2", "r1"));
}

TEST_F(RunCallsTest, BadPageIsSaid) {
  v1::ListJobsResponse page;
  EXPECT_EQ(ViolatedField(List(101, "", &page)), "page_size");
  EXPECT_EQ(ViolatedField(List(1, "x", &page)), "page_token");
}

TEST_F(RunCallsTest, RunningJobIsCancelled) {
  const v1::Job created = CreateOk("a");
  work_.AwaitBegun(1);
  v1::Job job;
  ASSERT_TRUE(Cancel(created.name(), &job).ok());
  EXPECT_TRUE(job.cancel_requested());
  work_.AllowAll();
  EXPECT_EQ(WaitOk(created.name()).state(), v1::JOB_STATE_CANCELLED);
}

TEST_F(RunCallsTest, RequestAboveAMebibyteIsRefusedAndTheServerLivesOn) {
  v1::CreateRunRequest request = RigRun("a");
  request.set_recording(std::string(2 << 20, 'a'));
  v1::Job job;
  EXPECT_EQ(Create(request, &job).error_code(), StatusCode::RESOURCE_EXHAUSTED);
  EXPECT_EQ(CreateOk("b").name(), "jobs/000001");
}

}  // namespace
}  // namespace eyebox::service
