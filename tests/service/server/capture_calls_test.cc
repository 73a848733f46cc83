// Captures on a simulated rig through the server, both ways round.
#include <absl/strings/str_cat.h>
#include <gtest/gtest.h>

#include <fstream>
#include <vector>

#include "capture/recording/reader.h"
#include "eyebox/v1/capture_service.grpc.pb.h"
#include "eyebox/v1/job_service.grpc.pb.h"
#include "eyebox/v1/recording_service.grpc.pb.h"
#include "service/server/capture_work.h"
#include "tests/service/server/server_fixture.h"

namespace eyebox::service {
namespace {

using grpc::StatusCode;

class CaptureCallsTest : public testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directories(Data());
    StartServer();
  }
  void TearDown() override { server_.reset(); }

  std::filesystem::path Data() const { return folder_.path() / "data"; }
  std::filesystem::path Partial(const std::string& id) const { return Data() / (".partial-" + id); }

  void StartServer() {
    auto work = WithCaptures(Data(), [](const Assignment&, const Watcher&) {
      return absl::InternalError("no other work in this test");
    });
    ASSERT_TRUE(work.ok()) << work.status();
    const std::string address = "unix:" + (folder_.path() / "eyebox.sock").string();
    auto server = Server::Start({.listen = address,
                                 .data = Data(),
                                 .state = folder_.path() / "state",
                                 .jobs = {},
                                 .access = {}},
                                *std::move(work), SystemClock());
    ASSERT_TRUE(server.ok()) << server.status();
    server_ = *std::move(server);
    const auto channel = grpc::CreateChannel(address, grpc::InsecureChannelCredentials());
    runs_ = v1::RunService::NewStub(channel);
    jobs_ = v1::JobService::NewStub(channel);
    captures_ = v1::CaptureService::NewStub(channel);
    recordings_ = v1::RecordingService::NewStub(channel);
  }
  void Restart() {
    server_.reset();
    StartServer();
  }

  // Four captures: a dark, a flat, two levels.
  v1::CapturePlan Plan() {
    v1::MakePlanRequest request;
    request.set_levels(2);
    request.add_exposures_s(0.0125);
    request.set_repeats(1);
    request.set_dark_repeats(1);
    request.set_flat_repeats(1);
    v1::CapturePlan plan;
    CallContext context;
    EXPECT_TRUE(captures_->MakePlan(&context, request, &plan).ok());
    return plan;
  }
  v1::CreateJobRequest Work(const std::string& id, bool session) {
    v1::CreateJobRequest request;
    request.set_request_id(absl::StrCat("r-", id, "-", ++requests_));
    v1::CaptureWork& work = *request.mutable_capture();
    work.set_recording_id(id);
    work.mutable_simulated()->set_name("rig");
    work.mutable_simulated()->set_camera_uri("sim:rift-s-like");
    work.mutable_simulated()->set_seed(3);
    *work.mutable_plan() = Plan();
    work.set_session(session);
    return request;
  }
  grpc::Status Create(const v1::CreateJobRequest& request, v1::Job* job) {
    CallContext context;
    return jobs_->CreateJob(&context, request, job);
  }
  std::string CreateOk(const v1::CreateJobRequest& request) {
    v1::Job job;
    const grpc::Status status = Create(request, &job);
    EXPECT_TRUE(status.ok()) << status.error_message();
    return job.name();
  }
  v1::Job Wait(const std::string& name) {
    CallContext context;
    v1::WaitJobRequest request;
    request.set_name(name);
    request.set_timeout_s(50);
    v1::Job job;
    EXPECT_TRUE(runs_->WaitJob(&context, request, &job).ok());
    return job;
  }
  v1::StimulusStep Next(const std::string& name, uint64_t after) {
    CallContext context;
    v1::NextStimulusRequest request;
    request.set_name(name);
    request.set_after_step(after);
    request.set_timeout_s(50);
    v1::StimulusStep step;
    const grpc::Status status = captures_->NextStimulus(&context, request, &step);
    EXPECT_TRUE(status.ok()) << status.error_message();
    return step;
  }
  grpc::Status Ack(const std::string& name, uint64_t step) {
    CallContext context;
    v1::AckShownRequest request;
    request.set_name(name);
    request.set_step(step);
    v1::AckShownReply reply;
    return captures_->AckShown(&context, request, &reply);
  }
  // Shows at most `most` stimuli; returns how many were asked for.
  int Show(const std::string& name, int most = 1000) {
    uint64_t shown = 0;
    for (int count = 0;; ++count) {
      const v1::StimulusStep step = Next(name, shown);
      if (step.step() == 0 || count == most) return count;
      EXPECT_FALSE(step.instruction().empty());
      EXPECT_TRUE(Ack(name, step.step()).ok());
      shown = step.step();
    }
  }
  grpc::Status Capture(const std::string& name, int number, const v1::CaptureSpec& spec,
                       v1::CaptureReply* reply) {
    v1::CaptureRequest request;
    request.set_name(name);
    request.set_number(number);
    *request.mutable_capture() = spec;
    while (true) {
      CallContext context;
      const grpc::Status status = captures_->Capture(&context, request, reply);
      if (status.error_code() != StatusCode::UNAVAILABLE) return status;
    }
  }
  grpc::Status Finish(const std::string& name) {
    CallContext context;
    v1::FinishCaptureRequest request;
    request.set_name(name);
    v1::Job job;
    return captures_->FinishCapture(&context, request, &job);
  }

  // All pixels of a recording below the served folder, capture by capture.
  std::vector<std::vector<uint16_t>> FramesOf(const std::string& id) {
    std::vector<std::vector<uint16_t>> frames;
    const auto reader = capture::RecordingReader::Open(Data() / id);
    EXPECT_TRUE(reader.ok()) << reader.status();
    if (!reader.ok()) return frames;
    for (const capture::CaptureEntry& entry : (*reader)->Captures()) {
      EXPECT_TRUE((*reader)
                      ->VisitFrames(entry,
                                    [&](const Frame& frame) {
                                      frames.emplace_back(frame.view.pixels_dn.begin(),
                                                          frame.view.pixels_dn.end());
                                      return absl::OkStatus();
                                    })
                      .ok());
    }
    return frames;
  }

  TemporaryFolder folder_;
  int requests_ = 0;
  std::unique_ptr<Server> server_;
  std::unique_ptr<v1::RunService::Stub> runs_;
  std::unique_ptr<v1::JobService::Stub> jobs_;
  std::unique_ptr<v1::CaptureService::Stub> captures_;
  std::unique_ptr<v1::RecordingService::Stub> recordings_;
};

TEST_F(CaptureCallsTest, PlanIsShownAndBecomesARecording) {
  const std::string name = CreateOk(Work("plan", false));
  EXPECT_GE(Show(name), 4);
  const v1::Job job = Wait(name);
  EXPECT_EQ(job.state(), v1::JOB_STATE_SUCCEEDED) << job.error_message();
  EXPECT_EQ(FramesOf("plan").size(), 4u);
  EXPECT_FALSE(std::filesystem::exists(Partial("plan")));
}

TEST_F(CaptureCallsTest, SessionGivesTheFramesOfThePlan) {
  EXPECT_GE(Show(CreateOk(Work("plan", false))), 4);
  const v1::CapturePlan plan = Plan();
  const std::string name = CreateOk(Work("session", true));
  for (int i = 0; i < plan.captures_size(); ++i) {
    v1::CaptureReply reply;
    const grpc::Status status = Capture(name, i + 1, plan.captures(i), &reply);
    ASSERT_TRUE(status.ok()) << status.error_message();
    EXPECT_EQ(reply.number(), i + 1);
    EXPECT_GT(reply.mean_dn(), 0);
    EXPECT_GT(reply.sigma_dn(), 0);
  }
  EXPECT_TRUE(Finish(name).ok());
  EXPECT_EQ(Wait(name).state(), v1::JOB_STATE_SUCCEEDED);
  EXPECT_EQ(FramesOf("session"), FramesOf("plan"));
}

TEST_F(CaptureCallsTest, NumberThatWasTakenGivesItsFiguresAgainAndWrongOnesAreRefused) {
  const v1::CapturePlan plan = Plan();
  const std::string name = CreateOk(Work("again", true));
  v1::CaptureReply first;
  v1::CaptureReply again;
  ASSERT_TRUE(Capture(name, 1, plan.captures(0), &first).ok());
  ASSERT_TRUE(Capture(name, 1, plan.captures(0), &again).ok());
  EXPECT_EQ(again.mean_dn(), first.mean_dn());
  EXPECT_EQ(Capture(name, 1, plan.captures(3), &again).error_code(), StatusCode::ALREADY_EXISTS);
  EXPECT_EQ(Capture(name, 5, plan.captures(3), &again).error_code(), StatusCode::OUT_OF_RANGE);
  v1::CaptureSpec wrong = plan.captures(0);
  wrong.set_exposure_s(-1);
  EXPECT_EQ(Capture(name, 2, wrong, &again).error_code(), StatusCode::INVALID_ARGUMENT);
  EXPECT_TRUE(Capture(name, 2, plan.captures(1), &again).ok()) << "the session goes on";
  EXPECT_TRUE(Finish(name).ok());
  EXPECT_EQ(Wait(name).state(), v1::JOB_STATE_SUCCEEDED);
}

TEST_F(CaptureCallsTest, StoppedServerGoesOnWithPlanAndSession) {
  EXPECT_GE(Show(CreateOk(Work("whole", false))), 4);
  const std::string plan_job = CreateOk(Work("cut", false));
  EXPECT_EQ(Show(plan_job, 2), 2);
  Restart();
  EXPECT_GE(Show(plan_job), 1);
  EXPECT_EQ(Wait(plan_job).state(), v1::JOB_STATE_SUCCEEDED);
  EXPECT_EQ(FramesOf("cut"), FramesOf("whole"));

  const v1::CapturePlan plan = Plan();
  const std::string session = CreateOk(Work("session", true));
  v1::CaptureReply reply;
  ASSERT_TRUE(Capture(session, 1, plan.captures(0), &reply).ok());
  Restart();
  for (int i = 0; i < plan.captures_size(); ++i) {
    ASSERT_TRUE(Capture(session, i + 1, plan.captures(i), &reply).ok());
  }
  EXPECT_TRUE(Finish(session).ok());
  EXPECT_EQ(Wait(session).state(), v1::JOB_STATE_SUCCEEDED);
  EXPECT_EQ(FramesOf("session"), FramesOf("whole"));
}

TEST_F(CaptureCallsTest, StreamTellsWhatToShowAndSurvivesAClientThatGoes) {
  const std::string name = CreateOk(Work("stream", false));
  v1::RunPlanRequest hello;
  hello.set_name(name);
  v1::StimulusStep step;
  {
    CallContext context;
    const auto stream = captures_->RunPlan(&context);
    ASSERT_TRUE(stream->Write(hello));
    ASSERT_TRUE(stream->Read(&step));
    EXPECT_GT(step.step(), 0u);
    context.TryCancel();
    EXPECT_EQ(stream->Finish().error_code(), StatusCode::CANCELLED);
  }
  CallContext context;
  const auto stream = captures_->RunPlan(&context);
  ASSERT_TRUE(stream->Write(hello));
  int shown = 0;
  while (stream->Read(&step) && step.step() != 0) {
    ++shown;
    v1::RunPlanRequest said;
    said.set_shown_step(step.step());
    stream->Write(said);
  }
  EXPECT_TRUE(stream->Finish().ok());
  EXPECT_GE(shown, 4);
  EXPECT_EQ(step.job().state(), v1::JOB_STATE_SUCCEEDED);
}

TEST_F(CaptureCallsTest, CancelledWhileItWaitsItLeavesWhatWasCapturedToResume) {
  const std::string name = CreateOk(Work("kept", false));
  EXPECT_EQ(Show(name, 2), 2);
  CallContext context;
  v1::CancelJobRequest cancel;
  cancel.set_name(name);
  v1::Job job;
  ASSERT_TRUE(runs_->CancelJob(&context, cancel, &job).ok());
  EXPECT_EQ(Wait(name).state(), v1::JOB_STATE_CANCELLED);
  EXPECT_EQ(Ack(name, 1).error_code(), StatusCode::FAILED_PRECONDITION);
  EXPECT_TRUE(std::filesystem::exists(Partial("kept")));

  const std::string refused = CreateOk(Work("kept", false));
  EXPECT_EQ(Wait(refused).error_code(), static_cast<int>(absl::StatusCode::kAlreadyExists));
  v1::CreateJobRequest resume = Work("kept", false);
  resume.mutable_capture()->set_resume(true);
  const std::string resumed = CreateOk(resume);
  EXPECT_GE(Show(resumed), 1);
  EXPECT_EQ(Wait(resumed).state(), v1::JOB_STATE_SUCCEEDED);
  EXPECT_EQ(FramesOf("kept").size(), 4u);
}

TEST_F(CaptureCallsTest, SilentClientEndsTheJobAndAnotherJobResumes) {
  v1::CreateJobRequest request = Work("silent", false);
  request.mutable_capture()->set_client_timeout_s(0.05);
  const v1::Job job = Wait(CreateOk(request));
  EXPECT_EQ(job.state(), v1::JOB_STATE_FAILED);
  EXPECT_EQ(job.error_code(), static_cast<int>(absl::StatusCode::kDeadlineExceeded));
}

TEST_F(CaptureCallsTest, BadRequestsAreRefusedWithTheField) {
  const auto code = [&](auto change) {
    v1::CreateJobRequest request = Work("bad", false);
    change(*request.mutable_capture());
    v1::Job job;
    return Create(request, &job).error_code();
  };
  using W = v1::CaptureWork;
  EXPECT_EQ(code([](W& w) { w.set_recording_id("../x"); }), StatusCode::INVALID_ARGUMENT);
  EXPECT_EQ(code([](W& w) { w.set_recording_id(".x"); }), StatusCode::INVALID_ARGUMENT);
  EXPECT_EQ(code([](W& w) { w.clear_source(); }), StatusCode::INVALID_ARGUMENT);
  EXPECT_EQ(code([](W& w) { w.mutable_simulated()->set_camera_uri("aravis:x"); }),
            StatusCode::INVALID_ARGUMENT);
  EXPECT_EQ(code([](W& w) { w.clear_plan(); }), StatusCode::INVALID_ARGUMENT);
  EXPECT_EQ(code([](W& w) { w.set_rig("rigs/none"); }), StatusCode::NOT_FOUND);
  EXPECT_EQ(code([](W& w) { w.set_client_timeout_s(-1); }), StatusCode::INVALID_ARGUMENT);
}

TEST_F(CaptureCallsTest, RigsRecordingsCapturesAndFramesAreListedAndRead) {
  std::ofstream(Data() / "left.textproto") << "name: \"left\" camera_uri: \"sim:rift-s-like\"\n";
  std::ofstream(Data() / "broken.textproto") << "nonsense: 1\n";
  v1::CreateJobRequest request = Work("seen", false);
  request.mutable_capture()->set_rig("rigs/left");
  EXPECT_GE(Show(CreateOk(request)), 4);

  v1::ListRigsResponse rigs;
  CallContext rigs_context;
  ASSERT_TRUE(recordings_->ListRigs(&rigs_context, {}, &rigs).ok());
  ASSERT_EQ(rigs.rigs_size(), 2);
  EXPECT_EQ(rigs.rigs(0).name(), "rigs/broken");
  EXPECT_FALSE(rigs.rigs(0).problem().empty());
  EXPECT_EQ(rigs.rigs(1).rig().camera_uri(), "sim:rift-s-like");

  v1::ListRecordingsResponse recordings;
  CallContext recordings_context;
  ASSERT_TRUE(recordings_->ListRecordings(&recordings_context, {}, &recordings).ok());
  ASSERT_EQ(recordings.recordings_size(), 1);
  EXPECT_EQ(recordings.recordings(0).name(), "recordings/seen");
  EXPECT_EQ(recordings.recordings(0).captures(), 4);

  v1::ListCapturesRequest page;
  page.set_parent("recordings/seen");
  page.set_page_size(3);
  v1::ListCapturesResponse captures;
  CallContext first_context;
  ASSERT_TRUE(recordings_->ListCaptures(&first_context, page, &captures).ok());
  EXPECT_EQ(captures.captures_size(), 3);
  page.set_page_token(captures.next_page_token());
  CallContext second_context;
  ASSERT_TRUE(recordings_->ListCaptures(&second_context, page, &captures).ok());
  ASSERT_EQ(captures.captures_size(), 1);
  EXPECT_TRUE(captures.next_page_token().empty());

  v1::ReadArrayRequest array;
  array.set_name(captures.captures(0).name());
  CallContext stream_context;
  const auto stream = recordings_->StreamArray(&stream_context, array);
  std::string bytes;
  v1::ArrayChunk chunk;
  while (stream->Read(&chunk)) {
    EXPECT_LE(chunk.data().size(), size_t{512} << 10);
    bytes += chunk.data();
  }
  EXPECT_TRUE(stream->Finish().ok());
  EXPECT_EQ(chunk.dtype(), "<u2");
  const std::vector<uint16_t> frame = FramesOf("seen").back();
  EXPECT_EQ(bytes, std::string(reinterpret_cast<const char*>(frame.data()), 2 * frame.size()));
  array.set_offset(bytes.size() - 4);
  CallContext unary_context;
  ASSERT_TRUE(recordings_->ReadArray(&unary_context, array, &chunk).ok());
  EXPECT_EQ(chunk.data(), bytes.substr(bytes.size() - 4));

  array.set_offset(0);
  array.set_frame(9);
  CallContext missing_context;
  EXPECT_EQ(recordings_->ReadArray(&missing_context, array, &chunk).error_code(),
            StatusCode::NOT_FOUND);
}

}  // namespace
}  // namespace eyebox::service
