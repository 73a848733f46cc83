// A server on a socket in a folder of its own, and a client of it.
#ifndef EYEBOX_TESTS_SERVICE_SERVER_SERVER_FIXTURE_H_
#define EYEBOX_TESTS_SERVICE_SERVER_SERVER_FIXTURE_H_

#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <string>

#include "eyebox/v1/service.grpc.pb.h"
#include "service/server/server.h"
#include "tests/service/server/manual_work.h"

namespace eyebox::service {

// Every call has a deadline, so that a fault ends the test instead of hanging it.
class CallContext : public grpc::ClientContext {
 public:
  CallContext() { set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(60)); }
};

class ServerFixture : public testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directories(folder_.path() / "data/rec/captures");
    StartServer();
  }
  void TearDown() override { StopServer(); }

  virtual ServerOptions Options() const {
    return {.listen = Address(),
            .data = folder_.path() / "data",
            .state = folder_.path() / "state",
            .jobs = {.queue_limit = 4}};
  }
  std::string Address() const { return "unix:" + Socket().string(); }
  std::filesystem::path Socket() const { return folder_.path() / "eyebox.sock"; }

  void StartServer() {
    auto server = Server::Start(Options(), work_.AsWork(), &clock_);
    ASSERT_TRUE(server.ok()) << server.status();
    server_ = *std::move(server);
    channel_ = grpc::CreateChannel(Address(), grpc::InsecureChannelCredentials());
    stub_ = v1::RunService::NewStub(channel_);
  }
  void StopServer() {
    work_.AllowAll();
    server_.reset();
  }

  grpc::Status Create(const v1::CreateRunRequest& request, v1::Job* job) {
    CallContext context;
    return stub_->CreateRun(&context, request, job);
  }
  v1::Job CreateOk(const std::string& request_id) {
    v1::Job job;
    const grpc::Status status = Create(RigRun(request_id), &job);
    EXPECT_TRUE(status.ok()) << status.error_message();
    return job;
  }
  grpc::Status Wait(const std::string& name, double timeout_s, v1::Job* job) {
    CallContext context;
    v1::WaitJobRequest request;
    request.set_name(name);
    request.set_timeout_s(timeout_s);
    return stub_->WaitJob(&context, request, job);
  }
  v1::Job WaitOk(const std::string& name) {
    v1::Job job;
    const grpc::Status status = Wait(name, 60, &job);
    EXPECT_TRUE(status.ok()) << status.error_message();
    return job;
  }
  v1::Job RunToItsEnd(const std::string& request_id) {
    work_.AllowAll();
    return WaitOk(CreateOk(request_id).name());
  }

  TemporaryFolder folder_;
  ManualClock clock_;
  ManualWork work_;
  std::unique_ptr<Server> server_;
  std::shared_ptr<grpc::Channel> channel_;
  std::unique_ptr<v1::RunService::Stub> stub_;
};

}  // namespace eyebox::service

#endif  // EYEBOX_TESTS_SERVICE_SERVER_SERVER_FIXTURE_H_
