// A client that opens a stream and reads nothing loses it, and others get its place.
#include <gmock/gmock.h>

#include <thread>
#include <vector>

#include "capture/base/npy.h"
#include "eyebox/v1/recording_service.grpc.pb.h"
#include "tests/service/server/server_fixture.h"

namespace eyebox::service {
namespace {

using grpc::StatusCode;

// More than gRPC takes in for a client that does not ask.
constexpr ImageSize kLarge{4096, 2048};
constexpr int kMostStreams = 8;

class StalledClientsTest : public ServerFixture {
 protected:
  ServerOptions Options() const override {
    ServerOptions options = ServerFixture::Options();
    options.stalled_after = std::chrono::milliseconds(100);
    return options;
  }

  std::string JobWithMap() {
    work_.SetFile("map.npy", EncodeNpy(Image<float>(kLarge, 1.0F)));
    return RunToItsEnd("a").name();
  }
  v1::ReadArrayRequest MapOf(const std::string& job) const {
    v1::ReadArrayRequest request;
    request.set_name(job);
    request.set_artifact("map.npy");
    return request;
  }
};

TEST_F(StalledClientsTest, ADownloadThatNobodyReadsEnds) {
  v1::DownloadArtifactRequest request;
  request.set_name(JobWithMap());
  request.set_artifact("map.npy");
  CallContext context;
  const auto reader = stub_->DownloadArtifact(&context, request);
  v1::ArtifactChunk chunk;
  ASSERT_TRUE(reader->Read(&chunk));
  std::this_thread::sleep_for(std::chrono::seconds(1));
  uint64_t received = chunk.data().size();
  while (reader->Read(&chunk)) received += chunk.data().size();
  EXPECT_EQ(reader->Finish().error_code(), StatusCode::CANCELLED);
  EXPECT_LT(received, chunk.total_bytes());
}

TEST_F(StalledClientsTest, AWatcherThatReadsNothingLosesItsStreamAndHoldsBackNobody) {
  constexpr int kEvents = 64;
  work_.SayMuch(kEvents, 100'000);
  const v1::Job job = CreateOk("a");
  v1::WatchJobRequest request;
  request.set_name(job.name());
  CallContext context;
  const auto reader = stub_->WatchJob(&context, request);
  v1::JobEvent event;
  ASSERT_TRUE(reader->Read(&event));
  work_.AllowAll();
  EXPECT_EQ(WaitOk(job.name()).state(), v1::JOB_STATE_SUCCEEDED);
  std::this_thread::sleep_for(std::chrono::seconds(1));
  uint32_t last = event.sequence();
  while (reader->Read(&event)) last = event.sequence();
  EXPECT_EQ(reader->Finish().error_code(), StatusCode::CANCELLED);
  EXPECT_LT(last, uint32_t{kEvents});
}

TEST_F(StalledClientsTest, PlacesOfStalledArrayStreamsAreFreeAgain) {
  const auto request = MapOf(JobWithMap());
  const auto arrays = v1::RecordingService::NewStub(channel_);
  std::vector<std::unique_ptr<CallContext>> contexts;
  std::vector<std::unique_ptr<grpc::ClientReader<v1::ArrayChunk>>> readers;
  for (int i = 0; i < kMostStreams; ++i) {
    contexts.push_back(std::make_unique<CallContext>());
    readers.push_back(arrays->StreamArray(contexts.back().get(), request));
  }
  const auto read_all = [&] {
    CallContext context;
    const auto reader = arrays->StreamArray(&context, request);
    v1::ArrayChunk chunk;
    uint64_t received = 0;
    while (reader->Read(&chunk)) received += chunk.data().size();
    return std::pair(reader->Finish().error_code(), received);
  };
  auto [code, received] = read_all();
  for (int attempt = 0; code == StatusCode::RESOURCE_EXHAUSTED && attempt < 600; ++attempt) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    std::tie(code, received) = read_all();
  }
  EXPECT_EQ(code, StatusCode::OK);
  EXPECT_EQ(received, kLarge.PixelCount() * sizeof(float));
  for (const auto& context : contexts) context->TryCancel();
  for (const auto& reader : readers) reader->Finish();
}

TEST_F(StalledClientsTest, AClientThatReadsSlowlyKeepsItsStream) {
  const auto request = MapOf(JobWithMap());
  const auto arrays = v1::RecordingService::NewStub(channel_);
  CallContext context;
  const auto reader = arrays->StreamArray(&context, request);
  v1::ArrayChunk chunk;
  uint64_t received = 0;
  while (reader->Read(&chunk)) {
    received += chunk.data().size();
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  EXPECT_EQ(reader->Finish().error_code(), StatusCode::OK);
  EXPECT_EQ(received, kLarge.PixelCount() * sizeof(float));
}

}  // namespace
}  // namespace eyebox::service
