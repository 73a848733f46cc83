// A client that waits for a server that is being started anew.
#ifndef EYEBOX_TESTS_FAULT_PERSISTENT_CLIENT_H_
#define EYEBOX_TESTS_FAULT_PERSISTENT_CLIENT_H_

#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <string>
#include <thread>

#include "eyebox/v1/capture_service.grpc.pb.h"
#include "eyebox/v1/job_service.grpc.pb.h"
#include "eyebox/v1/service.grpc.pb.h"

namespace eyebox::service {

// Calls until the server is there to answer.
template <typename Call>
grpc::Status Persist(const Call& call) {
  using std::chrono::steady_clock;
  const auto give_up = steady_clock::now() + std::chrono::seconds(120);
  while (true) {
    grpc::ClientContext context;
    context.set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(60));
    const grpc::Status status = call(&context);
    if (status.error_code() != grpc::StatusCode::UNAVAILABLE || steady_clock::now() > give_up) {
      return status;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
}

// Every call fails the test unless it succeeds.
class PersistentClient {
 public:
  explicit PersistentClient(const std::shared_ptr<grpc::Channel>& channel)
      : runs_(v1::RunService::NewStub(channel)),
        jobs_(v1::JobService::NewStub(channel)),
        captures_(v1::CaptureService::NewStub(channel)) {}

  std::string CreateRun(const std::string& id) {
    v1::CreateRunRequest request;
    request.set_request_id(id);
    request.mutable_rig()->set_name("rig");
    request.mutable_rig()->set_camera_uri("sim:rift-s-like");
    request.mutable_rig()->set_seed(3);
    v1::Job job;
    Expect(Persist([&](auto* context) { return runs_->CreateRun(context, request, &job); }));
    return job.name();
  }

  std::string CreateSession(const std::string& recording, const v1::CapturePlan& plan) {
    v1::CreateJobRequest request;
    request.set_request_id(recording);
    request.mutable_capture()->set_recording_id(recording);
    request.mutable_capture()->set_rig("rigs/left");
    request.mutable_capture()->set_session(true);
    *request.mutable_capture()->mutable_plan() = plan;
    v1::Job job;
    Expect(Persist([&](auto* context) { return jobs_->CreateJob(context, request, &job); }));
    return job.name();
  }

  v1::CapturePlan Plan() {
    v1::MakePlanRequest request;
    request.set_levels(24);
    request.add_exposures_s(0.0125);
    request.set_repeats(2);
    request.set_dark_repeats(2);
    request.set_flat_repeats(2);
    v1::CapturePlan plan;
    Expect(Persist([&](auto* context) { return captures_->MakePlan(context, request, &plan); }));
    return plan;
  }

  v1::CaptureReply Capture(const std::string& job, int number, const v1::CaptureSpec& spec) {
    v1::CaptureReply reply;
    Expect(Persist([&](auto* context) { return Capture(context, job, number, spec, &reply); }));
    return reply;
  }
  // One call, which may fail.
  grpc::Status Capture(grpc::ClientContext* context, const std::string& job, int number,
                       const v1::CaptureSpec& spec, v1::CaptureReply* reply) {
    v1::CaptureRequest request;
    request.set_name(job);
    request.set_number(number);
    *request.mutable_capture() = spec;
    return captures_->Capture(context, request, reply);
  }

  void Finish(const std::string& name) {
    v1::FinishCaptureRequest request;
    request.set_name(name);
    v1::Job job;
    Expect(
        Persist([&](auto* context) { return captures_->FinishCapture(context, request, &job); }));
  }

  v1::Job Wait(const std::string& name) {
    v1::WaitJobRequest request;
    request.set_name(name);
    request.set_timeout_s(50);
    v1::Job job;
    Expect(Persist([&](auto* context) { return runs_->WaitJob(context, request, &job); }));
    EXPECT_EQ(job.state(), v1::JOB_STATE_SUCCEEDED) << job.DebugString();
    return job;
  }

 private:
  static void Expect(const grpc::Status& status) {
    EXPECT_TRUE(status.ok()) << status.error_code() << ": " << status.error_message();
  }

  std::unique_ptr<v1::RunService::Stub> runs_;
  std::unique_ptr<v1::JobService::Stub> jobs_;
  std::unique_ptr<v1::CaptureService::Stub> captures_;
};

}  // namespace eyebox::service

#endif  // EYEBOX_TESTS_FAULT_PERSISTENT_CLIENT_H_
