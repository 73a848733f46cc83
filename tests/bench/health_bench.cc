// How soon a health check is answered over the unix socket while 64 streams run, on the wall clock.
// Server and clients share the processors. Counters, of single checks:
//   p50_ms, p99_ms  half and 99 of 100 are answered by then
//   streams_MB_s    what the streams carried meanwhile
// Argument 0: the streams watch a job that makes steps; 1: they download files as fast as they may.
#include <benchmark/benchmark.h>
#include <grpcpp/generic/generic_stub.h>
#include <grpcpp/grpcpp.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "capture/base/clock.h"
#include "capture/base/file.h"
#include "capture/base/status.h"
#include "eyebox/v1/service.grpc.pb.h"
#include "service/server/server.h"

namespace eyebox::service {
namespace {

constexpr int kStreams = 64;
constexpr size_t kFileBytes = size_t{8} << 20;
constexpr char kCheck[] = "/grpc.health.v1.Health/Check";

// Of "file" nothing but a file; of any other job steps until it is cancelled.
absl::Status DoWork(const Assignment& assignment, const Watcher& watcher) {
  if (assignment.request.request_id() != "file") {
    for (double done = 0.01;; done = std::min(0.99, done + 0.006)) {
      EYEBOX_RETURN_IF_ERROR(watcher.Reach(done, "a step"));
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
  }
  EYEBOX_RETURN_IF_ERROR(
      WriteFileAtomically(assignment.out / "map.npy", std::string(kFileBytes, 'x')));
  return WriteFileAtomically(assignment.out / "result.json", "{}");
}

class Bench {
 public:
  Bench() {
    std::string form = (std::filesystem::temp_directory_path() / "eyebox-XXXXXX").string();
    folder_ = mkdtemp(form.data());
    std::filesystem::create_directories(folder_ / "data");
    auto server =
        Server::Start({.listen = Address(), .data = folder_ / "data", .state = folder_ / "state"},
                      DoWork, SystemClock());
    if (!server.ok()) std::abort();
    server_ = *std::move(server);
  }
  ~Bench() {
    server_.reset();
    std::filesystem::remove_all(folder_);
  }

  std::shared_ptr<grpc::Channel> Connect() const {
    grpc::ChannelArguments arguments;
    arguments.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1);
    return grpc::CreateCustomChannel(Address(), grpc::InsecureChannelCredentials(), arguments);
  }

  std::string Create(const std::string& id) const {
    v1::CreateRunRequest request;
    request.set_request_id(id);
    request.mutable_rig()->set_name("rig");
    request.mutable_rig()->set_camera_uri("sim:rift-s-like");
    v1::Job job;
    const auto stub = v1::RunService::NewStub(Connect());
    grpc::ClientContext creating;
    if (!stub->CreateRun(&creating, request, &job).ok()) std::abort();
    v1::WaitJobRequest wait;
    wait.set_name(job.name());
    wait.set_timeout_s(id == "file" ? 60 : 0.1);
    grpc::ClientContext waiting;
    if (!stub->WaitJob(&waiting, wait, &job).ok()) std::abort();
    return job.name();
  }

 private:
  std::string Address() const { return "unix:" + (folder_ / "s").string(); }

  std::filesystem::path folder_;
  std::unique_ptr<Server> server_;
};

// Streams, eight to a connection, that begin again when they end, until this goes.
class Streams {
 public:
  Streams(const Bench& bench, bool download, const std::string& job) {
    for (int i = 0; i < kStreams; ++i) {
      if (i % 8 == 0) channels_.push_back(bench.Connect());
      threads_.emplace_back([this, channel = channels_.back(), download, job] {
        const auto stub = v1::RunService::NewStub(channel);
        while (!over_) download ? Download(*stub, job) : Watch(*stub, job);
      });
    }
  }
  ~Streams() {
    over_ = true;
    for (std::thread& thread : threads_) thread.join();
  }
  double bytes() const { return static_cast<double>(bytes_.load()); }

 private:
  void Download(v1::RunService::Stub& stub, const std::string& job) {
    v1::DownloadArtifactRequest request;
    request.set_name(job);
    request.set_artifact("map.npy");
    grpc::ClientContext context;
    const auto reader = stub.DownloadArtifact(&context, request);
    v1::ArtifactChunk chunk;
    while (!over_ && reader->Read(&chunk)) bytes_ += chunk.data().size();
    context.TryCancel();
  }

  // From the start to the newest event, and again: there is always something to send.
  void Watch(v1::RunService::Stub& stub, const std::string& job) {
    v1::WatchJobRequest request;
    request.set_name(job);
    grpc::ClientContext context;
    context.set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(1));
    const auto reader = stub.WatchJob(&context, request);
    v1::JobEvent event;
    while (!over_ && reader->Read(&event)) bytes_ += event.ByteSizeLong();
    context.TryCancel();
  }

  std::atomic<bool> over_ = false;
  std::atomic<uint64_t> bytes_ = 0;
  std::vector<std::shared_ptr<grpc::Channel>> channels_;
  std::vector<std::thread> threads_;
};

double CheckMs(grpc::GenericStub& stub) {
  const auto begin = std::chrono::steady_clock::now();
  grpc::ClientContext context;
  grpc::CompletionQueue queue;
  const grpc::Slice nothing;
  const auto call = stub.PrepareUnaryCall(&context, kCheck, grpc::ByteBuffer(&nothing, 1), &queue);
  call->StartCall();
  grpc::ByteBuffer answer;
  grpc::Status status;
  call->Finish(&answer, &status, nullptr);
  void* tag = nullptr;
  bool ok = false;
  if (!queue.Next(&tag, &ok) || !status.ok()) std::abort();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin)
      .count();
}

void HealthCheck(benchmark::State& state) {
  const bool download = state.range(0) != 0;
  const Bench bench;
  const std::string job = bench.Create(download ? "file" : "steps");
  grpc::GenericStub stub(bench.Connect());
  CheckMs(stub);  // connects
  std::vector<double> times_ms;
  double carried = 0;
  double seconds = 0;
  {
    const Streams streams(bench, download, job);
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    const double before = streams.bytes();
    const auto begin = std::chrono::steady_clock::now();
    for (auto _ : state) times_ms.push_back(CheckMs(stub));
    seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    carried = streams.bytes() - before;
  }
  if (!download) {
    v1::CancelJobRequest cancel;
    cancel.set_name(job);
    v1::Job cancelled;
    grpc::ClientContext context;
    v1::RunService::NewStub(bench.Connect())->CancelJob(&context, cancel, &cancelled);
  }
  std::ranges::sort(times_ms);
  state.counters["p50_ms"] = times_ms[times_ms.size() / 2];
  state.counters["p99_ms"] = times_ms[times_ms.size() * 99 / 100];
  state.counters["streams_MB_s"] = carried / seconds / 1e6;
}

BENCHMARK(HealthCheck)
    ->ArgName("download")
    ->Arg(0)
    ->Arg(1)
    ->Iterations(2000)
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace eyebox::service
