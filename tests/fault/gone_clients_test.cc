// Clients that go away in the middle of a stream, and clients that never read one: what they held
// is given back, memory stays bounded, and others are answered.
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "eyebox/v1/capture_service.grpc.pb.h"
#include "eyebox/v1/job_service.grpc.pb.h"
#include "eyebox/v1/recording_service.grpc.pb.h"
#include "tests/fault/recorder_run.h"
#include "tests/fault/served_eyebox.h"
#include "tests/fault/server_process.h"
#include "tests/support/temporary_folder.h"

namespace eyebox::service {
namespace {

using grpc::StatusCode;

constexpr int kSidePx = 3000;
constexpr int kArrayBytes = 2 * kSidePx * kSidePx;
constexpr int kArrayStreams = 8;  // that the server allows at once

class Context : public grpc::ClientContext {
 public:
  Context() { set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(100)); }
};

template <typename Message>
struct Stream {
  std::unique_ptr<Context> context = std::make_unique<Context>();
  std::unique_ptr<grpc::ClientReader<Message>> reader = {};
};

enum class Leaves { kByCancel, kByClosingItsChannel };

class GoneClients : public testing::TestWithParam<Leaves> {
 protected:
  void SetUp() override {
    std::filesystem::create_directories(folder_ / "data");
    const capture::RecorderRun run = capture::RunRecorder(folder_ / "data/big", "", 1, 1, kSidePx);
    ASSERT_EQ(run.exit_code, 0) << run.errors;
    server_ = std::make_unique<ServedEyebox>(
        folder_.path(), std::vector<std::string>{},
        std::vector<std::string>{"--metrics", "127.0.0.1:" + std::to_string(port_)});
    recordings_ = v1::RecordingService::NewStub(server_->Connect());
    v1::ListCapturesRequest request;
    request.set_parent("recordings/big");
    v1::ListCapturesResponse captures;
    Context context;
    const grpc::Status status = recordings_->ListCaptures(&context, request, &captures);
    ASSERT_TRUE(status.ok()) << status.error_message();
    ASSERT_EQ(captures.captures_size(), 1);
    array_.set_name(captures.captures(0).name());
  }

  Stream<v1::ArrayChunk> OpenArray(v1::RecordingService::Stub& stub) const {
    Stream<v1::ArrayChunk> stream;
    stream.reader = stub.StreamArray(stream.context.get(), array_);
    return stream;
  }

  int64_t BytesOf(Stream<v1::ArrayChunk>& stream) const {
    int64_t bytes = 0;
    v1::ArrayChunk chunk;
    while (stream.reader->Read(&chunk)) bytes += static_cast<int64_t>(chunk.data().size());
    const grpc::Status status = stream.reader->Finish();
    EXPECT_TRUE(status.ok()) << status.error_message();
    return bytes;
  }

  // A job that waits for its client until the test ends.
  std::string CreateSession() {
    v1::CreateJobRequest request;
    request.set_request_id("session");
    request.mutable_capture()->set_recording_id("session");
    request.mutable_capture()->mutable_simulated()->set_name("rig");
    request.mutable_capture()->mutable_simulated()->set_camera_uri("sim:rift-s-like");
    request.mutable_capture()->set_session(true);
    v1::Job job;
    Context context;
    const grpc::Status status =
        v1::JobService::NewStub(server_->Connect())->CreateJob(&context, request, &job);
    EXPECT_TRUE(status.ok()) << status.error_message();
    return job.name();
  }

  double OpenCalls() const { return Figure(port_, "eyebox_calls_open"); }

  // Opens `count` streams on a connection of their own, reads a message of each, and goes.
  template <typename Message>
  void OpenAndLeave(
      int count,
      const std::function<Stream<Message>(const std::shared_ptr<grpc::Channel>&)>& open) {
    std::shared_ptr<grpc::Channel> channel = server_->Connect();
    std::vector<Stream<Message>> streams;
    for (int i = 0; i < count; ++i) {
      streams.push_back(open(channel));
      Message message;
      ASSERT_TRUE(streams.back().reader->Read(&message)) << "stream " << i;
    }
    EXPECT_EQ(OpenCalls(), count);
    if (GetParam() == Leaves::kByCancel) {
      for (Stream<Message>& stream : streams) stream.context->TryCancel();
      for (Stream<Message>& stream : streams) {
        EXPECT_EQ(stream.reader->Finish().error_code(), StatusCode::CANCELLED);
      }
    }
    for (Stream<Message>& stream : streams) {  // its end was not asked for: it is broken off
      stream.reader.reset();
      stream.context.reset();
    }
    streams.clear();
    channel.reset();
    EXPECT_EQ(AwaitAtMost(0, [&] { return OpenCalls(); }), 0);
  }

  const TemporaryFolder folder_;
  const int port_ = FreePort();
  std::unique_ptr<ServedEyebox> server_;
  std::unique_ptr<v1::RecordingService::Stub> recordings_;
  v1::ReadArrayRequest array_;
};

INSTANTIATE_TEST_SUITE_P(Ways, GoneClients,
                         testing::Values(Leaves::kByCancel, Leaves::kByClosingItsChannel),
                         [](const auto& test) {
                           return test.param == Leaves::kByCancel ? "Cancel" : "Close";
                         });

TEST_P(GoneClients, InTheMiddleOfAnArrayGiveBackWhatTheyHeld) {
  const int files = OpenFilesOf(server_->process());
  for (int round = 0; round < 2; ++round) {
    OpenAndLeave<v1::ArrayChunk>(kArrayStreams, [&](const auto& channel) {
      return OpenArray(*v1::RecordingService::NewStub(channel));
    });
  }
  std::vector<Stream<v1::ArrayChunk>> whole;
  for (int i = 0; i < kArrayStreams; ++i) whole.push_back(OpenArray(*recordings_));
  for (auto& stream : whole) EXPECT_EQ(BytesOf(stream), kArrayBytes);
  EXPECT_LE(AwaitAtMost(files, [&] { return OpenFilesOf(server_->process()); }), files);
  EXPECT_EQ(server_->Stop(), 0);
}

TEST_P(GoneClients, WhoWatchAJobLeaveItRunning) {
  v1::WatchJobRequest request;
  request.set_name(CreateSession());
  for (int round = 0; round < 2; ++round) {
    OpenAndLeave<v1::JobEvent>(100, [&](const auto& channel) {
      Stream<v1::JobEvent> stream;
      stream.reader = v1::RunService::NewStub(channel)->WatchJob(stream.context.get(), request);
      return stream;
    });
  }
  v1::GetJobRequest get;
  get.set_name(request.name());
  v1::Job job;
  Context context;
  ASSERT_TRUE(server_->stub().GetJob(&context, get, &job).ok());
  EXPECT_EQ(job.state(), v1::JOB_STATE_RUNNING) << job.DebugString();
  EXPECT_TRUE(IsServing(*server_));
}

using SlowClients = GoneClients;
INSTANTIATE_TEST_SUITE_P(Ways, SlowClients, testing::Values(Leaves::kByCancel));

TEST_P(SlowClients, WhoNeverReadAnArrayCostBoundedMemoryAndHoldUpNobody) {
  auto first = OpenArray(*recordings_);
  EXPECT_EQ(BytesOf(first), kArrayBytes);  // what is allocated once is allocated
  const Memory before = MemoryOf(server_->process());
  constexpr int kClients = 64;
  std::vector<Stream<v1::ArrayChunk>> silent;
  const auto stub = v1::RecordingService::NewStub(server_->Connect());
  for (int i = 0; i < kClients; ++i) silent.push_back(OpenArray(*stub));
  // The others are refused, and the eight stay. The place of `first` may be freed late: whoever
  // comes then gets it.
  for (int i = 0; i < 1000 && OpenCalls() != kArrayStreams; ++i) {
    if (OpenCalls() < kArrayStreams) silent.push_back(OpenArray(*stub));
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  EXPECT_EQ(OpenCalls(), kArrayStreams);

  v1::ArrayChunk chunk;
  Context reading;
  EXPECT_TRUE(recordings_->ReadArray(&reading, array_, &chunk).ok()) << "the unary twin answers";
  v1::ListJobsResponse jobs;
  Context listing;
  EXPECT_TRUE(server_->stub().ListJobs(&listing, {}, &jobs).ok());
  EXPECT_TRUE(IsServing(*server_));
  auto refused = OpenArray(*recordings_);
  EXPECT_FALSE(refused.reader->Read(&chunk));
  EXPECT_EQ(refused.reader->Finish().error_code(), StatusCode::RESOURCE_EXHAUSTED);

  // Each holds its array, twice while it is read, and two disk threads read at once.
  constexpr int64_t kSlackKib = int64_t{96} << 10;
  const int64_t most_kib = before.now_kib + (kArrayStreams + 2) * (kArrayBytes >> 10) + kSlackKib;
  const Memory during = MemoryOf(server_->process());
  EXPECT_LE(during.most_kib, most_kib);
  for (auto& stream : silent) stream.context->TryCancel();
  for (auto& stream : silent) EXPECT_FALSE(stream.reader->Finish().ok());
  EXPECT_EQ(AwaitAtMost(0, [&] { return OpenCalls(); }), 0);
  auto again = OpenArray(*recordings_);
  EXPECT_EQ(BytesOf(again), kArrayBytes);
  std::printf("VmRSS %lld MiB before, %lld MiB with %d clients that never read, most %lld MiB\n",
              static_cast<long long>(before.now_kib >> 10),
              static_cast<long long>(during.now_kib >> 10), kClients,
              static_cast<long long>(during.most_kib >> 10));
  EXPECT_EQ(server_->Stop(), 0);
}

}  // namespace
}  // namespace eyebox::service
