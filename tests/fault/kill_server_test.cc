// kill -9 of the server at any moment: a run on a rig starts again by itself and gives the bytes of
// a run that nothing disturbed, and every capture that a session acknowledged is still there.
//
// EYEBOX_KILLS=100 kills so often instead of a few times.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "capture/base/file.h"
#include "capture/recording/reader.h"
#include "eyebox/v1/capture_service.grpc.pb.h"
#include "eyebox/v1/job_service.grpc.pb.h"
#include "tests/fault/served_eyebox.h"
#include "tests/support/temporary_folder.h"

namespace eyebox::service {
namespace {

namespace fs = std::filesystem;
using std::chrono::steady_clock;

// A job that is started for the fourth time is given up: it might be what kills the server.
constexpr int kKillsOfAJob = 2;

int KillCount() {
  const char* asked = std::getenv("EYEBOX_KILLS");
  return asked ? std::atoi(asked) : 4;
}

// Calls until the server is there to answer.
template <typename Call>
grpc::Status Persist(const Call& call) {
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

// Of a job that has ended: by name, the bytes of its artifacts.
using Files = std::map<std::string, std::string>;
// Of a recording: the pixels of every frame of its whole captures. One that a kill cut short stays
// beside the one that was taken in its place.
using Pixels = std::vector<std::vector<uint16_t>>;

class Client {
 public:
  explicit Client(const std::shared_ptr<grpc::Channel>& channel)
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
    v1::CaptureRequest request;
    request.set_name(job);
    request.set_number(number);
    *request.mutable_capture() = spec;
    v1::CaptureReply reply;
    Expect(Persist([&](auto* context) { return captures_->Capture(context, request, &reply); }));
    return reply;
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

class KillServer : public testing::Test {
 protected:
  void SetUp() override {
    fs::create_directories(folder_ / "data");
    std::ofstream(folder_ / "data/left.textproto")
        << "name: \"left\" camera_uri: \"sim:rift-s-like\" seed: 5\n";
    Start();
  }

  void Start() {
    server_ = std::make_unique<ServedEyebox>(folder_.path(), std::vector<std::string>{});
  }

  Files FilesOf(const v1::Job& job) {
    Files files;
    for (const v1::Artifact& artifact : job.artifacts()) {
      const auto bytes =
          ReadWholeFile(folder_.path() / "state" / job.name() / "result" / artifact.name());
      EXPECT_TRUE(bytes.ok()) << bytes.status();
      files[artifact.name()] = bytes.ok() ? *bytes : "";
    }
    EXPECT_FALSE(files.empty());
    return files;
  }

  Pixels PixelsOf(const std::string& recording) {
    Pixels pixels;
    const auto reader = capture::RecordingReader::Open(folder_ / ("data/" + recording));
    EXPECT_TRUE(reader.ok()) << reader.status();
    if (!reader.ok()) return pixels;
    for (const capture::CaptureEntry& entry : (*reader)->Captures()) {
      if (entry.frame_count < entry.spec.repeats) {
        ++cut_short_;
        continue;
      }
      const absl::Status read = (*reader)->VisitFrames(entry, [&](const Frame& frame) {
        pixels.emplace_back(frame.view.pixels_dn.begin(), frame.view.pixels_dn.end());
        return absl::OkStatus();
      });
      EXPECT_TRUE(read.ok()) << read;
    }
    return pixels;
  }

  // A run and a session beside it until both have ended, killed `kills` times meanwhile. Repeats
  // what was acknowledged: an answer that has changed would be a capture that was lost.
  void Round(const std::string& id, int kills) {
    Client client(server_->Connect());
    const v1::CapturePlan plan = client.Plan();
    const std::string run = client.CreateRun("run-" + id);
    const std::string session = client.CreateSession("session-" + id, plan);
    std::vector<v1::CaptureReply> replies;
    std::thread script([&] {
      for (int i = 0; i < plan.captures_size(); ++i) {
        replies.push_back(client.Capture(session, i + 1, plan.captures(i)));
        ++acknowledged_;
      }
      for (int i = 0; i < plan.captures_size(); ++i) {
        const v1::CaptureReply again = client.Capture(session, i + 1, plan.captures(i));
        EXPECT_EQ(again.mean_dn(), replies[i].mean_dn()) << "capture " << i + 1;
        EXPECT_EQ(again.sigma_dn(), replies[i].sigma_dn()) << "capture " << i + 1;
      }
    });
    for (int i = 0; i < kills; ++i) KillAtRandom();
    script.join();
    client.Finish(session);
    const v1::Job run_job = client.Wait(run);
    const v1::Job session_job = client.Wait(session);
    run_kills_ += run_job.attempts() - 1;
    session_kills_ += session_job.attempts() - 1;
    files_ = FilesOf(run_job);
    pixels_ = PixelsOf("session-" + id);
    means_.clear();
    for (const v1::CaptureReply& reply : replies) means_.push_back(reply.mean_dn());
  }

  void KillAtRandom() {
    std::uniform_real_distribution<double> moment_s(0, round_s_);
    std::this_thread::sleep_for(std::chrono::duration<double>(moment_s(random_)));
    EXPECT_EQ(server_->Kill(), 128 + SIGKILL) << "it had ended by itself";
    Start();
  }

  const TemporaryFolder folder_;
  std::unique_ptr<ServedEyebox> server_;
  std::mt19937 random_{11};
  double round_s_ = 0;
  // Of the last round.
  Files files_;
  Pixels pixels_;
  std::vector<double> means_;
  // Of all rounds.
  std::atomic<int> acknowledged_ = 0;
  int run_kills_ = 0;
  int session_kills_ = 0;
  int cut_short_ = 0;
};

TEST_F(KillServer, AtAnyMomentLosesNoCaptureAndChangesNoByteOfAResult) {
  const auto begin = steady_clock::now();
  Round("whole", 0);
  round_s_ = std::chrono::duration<double>(steady_clock::now() - begin).count();
  const Files files = files_;
  const Pixels pixels = pixels_;
  const std::vector<double> means = means_;
  ASSERT_GE(pixels.size(), 50u);
  const int kills = KillCount();
  for (int done = 0; done < kills && !HasFailure(); done += kKillsOfAJob) {
    Round(std::to_string(done), std::min(kKillsOfAJob, kills - done));
    EXPECT_EQ(means_, means);
    EXPECT_TRUE(pixels_ == pixels) << "frames differ";
    ASSERT_EQ(files_.size(), files.size());
    for (const auto& [name, bytes] : files) EXPECT_TRUE(files_[name] == bytes) << name;
  }
  std::printf(
      "%d kills, %d while the run and %d while the session was under way; %d captures "
      "acknowledged, %d cut short and taken again; a round takes %.2f s undisturbed\n",
      kills, run_kills_, session_kills_, acknowledged_.load(), cut_short_, round_s_);
  EXPECT_EQ(server_->Stop(), 0);
}

}  // namespace
}  // namespace eyebox::service
