// Many clients at once that list, create, watch, wait, cancel, capture and download: each gets what
// is its own. Built with the preset tsan it shows races.
//
// EYEBOX_CLIENTS=50 lets so many in instead of a few.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "capture/base/npy.h"
#include "eyebox/v1/capture_service.grpc.pb.h"
#include "eyebox/v1/job_service.grpc.pb.h"
#include "eyebox/v1/recording_service.grpc.pb.h"
#include "tests/service/server/server_fixture.h"

namespace eyebox::service {
namespace {

using grpc::StatusCode;

constexpr int kRigs = 3;
constexpr int kCaptures = 3;
constexpr int kSidePx = 400;  // of a map: more than one chunk

int ClientCount() {
  const char* asked = std::getenv("EYEBOX_CLIENTS");
  return asked ? std::atoi(asked) : 16;
}

// A session that answers at once, without a camera.
absl::Status HoldSession(const Assignment& assignment, const Watcher& watcher) {
  assignment.desk->Open(StimulusDesk::Way::kSession);
  while (true) {
    EYEBOX_ASSIGN_OR_RETURN(
        const StimulusDesk::Order order,
        assignment.desk->AwaitOrder(watcher.cancelled, std::chrono::milliseconds(60000)));
    if (order.finish) return absl::OkStatus();
    v1::CaptureReply reply;
    reply.set_number(order.request.number());
    reply.set_mean_dn(2.0 * order.request.number());
    assignment.desk->Answer(reply);
  }
}

absl::Status DoWork(const Assignment& assignment, const Watcher& watcher) {
  if (assignment.request.has_capture()) return HoldSession(assignment, watcher);
  constexpr int kSteps = 20;
  for (int step = 1; step <= kSteps; ++step) {
    EYEBOX_RETURN_IF_ERROR(watcher.Reach(static_cast<double>(step) / kSteps, "a step"));
  }
  Image<float> map({.width_px = kSidePx, .height_px = kSidePx});
  std::ranges::fill(map.pixels(), 0.5F);
  EYEBOX_RETURN_IF_ERROR(WriteFileAtomically(assignment.out / "map.npy", EncodeNpy(map)));
  return WriteFileAtomically(assignment.out / "result.json", "{}");
}

// One client with calls of its own; shares its channel with others.
class Client {
 public:
  Client(int number, const std::shared_ptr<grpc::Channel>& channel)
      : number_(number),
        runs_(v1::RunService::NewStub(channel)),
        jobs_(v1::JobService::NewStub(channel)),
        captures_(v1::CaptureService::NewStub(channel)),
        recordings_(v1::RecordingService::NewStub(channel)) {}

  void List() {
    CallContext context;
    v1::ListJobsRequest request;
    request.set_page_size(5);
    v1::ListJobsResponse response;
    Expect(runs_->ListJobs(&context, request, &response));
    EXPECT_LE(response.jobs_size(), 5);
  }

  std::string Create(const std::string& id) {
    CallContext context;
    v1::Job job;
    Expect(jobs_->CreateJob(&context, RigJob(id), &job));
    EXPECT_EQ(Get(job.name()).request_id(), id);
    return job.name();
  }

  v1::Job Get(const std::string& name) {
    CallContext context;
    v1::GetJobRequest request;
    request.set_name(name);
    v1::Job job;
    Expect(runs_->GetJob(&context, request, &job));
    return job;
  }

  // Every event once and in order, to the end; or goes away after the first.
  void Watch(const std::string& name, bool to_the_end) {
    CallContext context;
    v1::WatchJobRequest request;
    request.set_name(name);
    const auto reader = runs_->WatchJob(&context, request);
    v1::JobEvent event;
    uint32_t expected = 1;
    for (; reader->Read(&event); ++expected) {
      EXPECT_EQ(event.sequence(), expected);
      EXPECT_EQ(event.job().name(), name);
      if (!to_the_end) context.TryCancel();
    }
    const grpc::Status status = reader->Finish();
    if (to_the_end) {
      Expect(status);
      EXPECT_TRUE(HasEnded(event.job()));
    }
    EXPECT_GT(expected, 1u);
  }

  void Cancel(const std::string& name) {
    CallContext context;
    v1::CancelJobRequest request;
    request.set_name(name);
    v1::Job job;
    Expect(runs_->CancelJob(&context, request, &job));
    const v1::Job ended = Wait(name);
    EXPECT_TRUE(ended.state() == v1::JOB_STATE_CANCELLED ||
                ended.state() == v1::JOB_STATE_SUCCEEDED)
        << ended.DebugString();
  }

  v1::Job Wait(const std::string& name) {
    CallContext context;
    v1::WaitJobRequest request;
    request.set_name(name);
    request.set_timeout_s(60);
    v1::Job job;
    Expect(runs_->WaitJob(&context, request, &job));
    EXPECT_TRUE(HasEnded(job)) << job.DebugString();
    return job;
  }

  void DownloadMap(const std::string& name) {
    v1::ReadArrayRequest request;
    request.set_name(name);
    request.set_artifact("map.npy");
    grpc::Status status;
    std::string bytes;
    do {  // others may hold all streams of arrays
      CallContext context;
      const auto reader = recordings_->StreamArray(&context, request);
      v1::ArrayChunk chunk;
      bytes.clear();
      while (reader->Read(&chunk)) bytes += chunk.data();
      status = reader->Finish();
    } while (status.error_code() == StatusCode::RESOURCE_EXHAUSTED);
    Expect(status);
    const std::vector<float> map(size_t{kSidePx} * kSidePx, 0.5F);
    EXPECT_TRUE(bytes == std::string(reinterpret_cast<const char*>(map.data()), 4 * map.size()));

    CallContext context;
    v1::DownloadArtifactRequest download;
    download.set_name(name);
    download.set_artifact("map.npy");
    const auto reader = runs_->DownloadArtifact(&context, download);
    v1::ArtifactChunk chunk;
    uint64_t total = 0;
    while (reader->Read(&chunk)) total += chunk.data().size();
    Expect(reader->Finish());
    EXPECT_GT(total, bytes.size());
    EXPECT_EQ(total, chunk.total_bytes());
  }

  std::string CreateSession(const std::string& id) {
    v1::CreateJobRequest request;
    request.set_request_id(id);
    request.mutable_capture()->set_recording_id(id);
    request.mutable_capture()->set_rig("rigs/r" + std::to_string(number_ % kRigs));
    request.mutable_capture()->set_session(true);
    CallContext context;
    v1::Job job;
    Expect(jobs_->CreateJob(&context, request, &job));
    return job.name();
  }

  void CaptureAndFinish(const std::string& session) {
    for (int number = 1; number <= kCaptures; ++number) {
      v1::CaptureRequest request;
      request.set_name(session);
      request.set_number(number);
      request.mutable_capture()->set_exposure_s(0.01);
      request.mutable_capture()->set_repeats(1);
      v1::CaptureReply reply;
      Expect(OnceItsTurnHasCome([&](grpc::ClientContext* context) {
        return captures_->Capture(context, request, &reply);
      }));
      EXPECT_EQ(reply.number(), number);
      EXPECT_EQ(reply.mean_dn(), 2.0 * number);
    }
    v1::FinishCaptureRequest request;
    request.set_name(session);
    v1::Job job;
    Expect(OnceItsTurnHasCome([&](grpc::ClientContext* context) {
      return captures_->FinishCapture(context, request, &job);
    }));
    Wait(session);
  }

 private:
  template <typename Call>
  static grpc::Status OnceItsTurnHasCome(const Call& call) {
    while (true) {
      CallContext context;
      const grpc::Status status = call(&context);
      if (status.error_code() != StatusCode::UNAVAILABLE) return status;
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
  }

  static void Expect(const grpc::Status& status) {
    EXPECT_TRUE(status.ok()) << status.error_code() << ": " << status.error_message();
  }

  const int number_;
  const std::unique_ptr<v1::RunService::Stub> runs_;
  const std::unique_ptr<v1::JobService::Stub> jobs_;
  const std::unique_ptr<v1::CaptureService::Stub> captures_;
  const std::unique_ptr<v1::RecordingService::Stub> recordings_;
};

class ManyClients : public testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directories(folder_.path() / "data");
    for (int i = 0; i < kRigs; ++i) {
      std::ofstream(folder_.path() / ("data/r" + std::to_string(i) + ".textproto"))
          << "name: \"r\" camera_uri: \"sim:rift-s-like\"\n";
    }
    auto server = Server::Start({.listen = Address(),
                                 .data = folder_.path() / "data",
                                 .state = folder_.path() / "state",
                                 .jobs = {.queue_limit = 1000},
                                 .metrics = "127.0.0.1:0"},
                                DoWork, SystemClock());
    ASSERT_TRUE(server.ok()) << server.status();
    server_ = *std::move(server);
  }
  std::string Address() const { return "unix:" + (folder_.path() / "s").string(); }

  std::shared_ptr<grpc::Channel> Connect() const {
    grpc::ChannelArguments arguments;
    arguments.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1);
    return grpc::CreateCustomChannel(Address(), grpc::InsecureChannelCredentials(), arguments);
  }

  TemporaryFolder folder_;
  std::unique_ptr<Server> server_;
};

TEST_F(ManyClients, WithMixedCallsEachGetsItsOwn) {
  const int count = ClientCount();
  std::vector<std::shared_ptr<grpc::Channel>> channels;
  for (int i = 0; i < 5; ++i) channels.push_back(Connect());
  std::mutex mutex;
  std::set<std::string> shared;  // names of the job that all of them create
  std::vector<std::thread> threads;
  for (int i = 0; i < count; ++i) {
    threads.emplace_back([&, i] {
      Client client(i, channels[static_cast<size_t>(i) % channels.size()]);
      const std::string id = std::to_string(i);
      client.List();
      const std::string session = client.CreateSession("session-" + id);
      const std::string run = client.Create("run-" + id);
      const std::string common = client.Create("common");
      {
        const std::lock_guard lock(mutex);
        shared.insert(common);
      }
      client.Watch(run, i % 3 != 0);
      if (i % 4 == 0) client.Cancel(client.Create("cancelled-" + id));
      if (i % 8 == 1) client.Cancel(session);
      client.Wait(common);
      client.DownloadMap(common);
      if (i % 8 != 1) client.CaptureAndFinish(session);
      client.List();
      EXPECT_EQ(client.Wait(run).state(), v1::JOB_STATE_SUCCEEDED);
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(shared.size(), 1u);
}

TEST_F(ManyClients, AreToldWhenTheServerStops) {
  Client first(0, Connect());
  const std::string session = first.CreateSession("endless");
  std::atomic<int> told = 0;
  std::atomic<int> watching = 0;
  std::vector<std::thread> threads;
  const int count = ClientCount();
  for (int i = 0; i < count; ++i) {
    threads.emplace_back([&] {
      const auto stub = v1::RunService::NewStub(Connect());
      CallContext context;
      v1::WatchJobRequest request;
      request.set_name(session);
      const auto reader = stub->WatchJob(&context, request);
      v1::JobEvent event;
      EXPECT_TRUE(reader->Read(&event));
      ++watching;
      watching.notify_all();
      while (reader->Read(&event)) {
      }
      if (reader->Finish().error_code() == StatusCode::UNAVAILABLE) ++told;
    });
  }
  for (int now = watching; now < count; now = watching) watching.wait(now);
  server_->Stop();
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(told, count);
}

}  // namespace
}  // namespace eyebox::service
