// GetRunResult, DownloadArtifact, ReadArtifact over the socket.
#include <gmock/gmock.h>

#include "tests/service/server/server_fixture.h"

namespace eyebox::service {
namespace {

using grpc::StatusCode;

class ArtifactCallsTest : public ServerFixture {
 protected:
  grpc::Status Result(const std::string& name, v1::RunResult* result) {
    CallContext context;
    v1::GetRunResultRequest request;
    request.set_name(name);
    return stub_->GetRunResult(&context, request, result);
  }
  grpc::Status Read(const std::string& name, const std::string& artifact, uint64_t offset,
                    uint32_t limit_bytes, v1::ArtifactChunk* chunk) {
    CallContext context;
    v1::ReadArtifactRequest request;
    request.set_name(name);
    request.set_artifact(artifact);
    request.set_offset(offset);
    request.set_limit_bytes(limit_bytes);
    return stub_->ReadArtifact(&context, request, chunk);
  }
  grpc::Status Download(const std::string& name, const std::string& artifact,
                        std::vector<v1::ArtifactChunk>* chunks) {
    CallContext context;
    v1::DownloadArtifactRequest request;
    request.set_name(name);
    request.set_artifact(artifact);
    const auto reader = stub_->DownloadArtifact(&context, request);
    for (v1::ArtifactChunk chunk; reader->Read(&chunk);) chunks->push_back(chunk);
    return reader->Finish();
  }
};

// Differs at every offset that a fault would confuse.
std::string Pattern(size_t bytes) {
  std::string pattern(bytes, 0);
  for (size_t i = 0; i < bytes; ++i) pattern[i] = static_cast<char>(i * 2654435761u >> 24);
  return pattern;
}

TEST_F(ArtifactCallsTest, LargeFileComesInChunksBitForBit) {
  const std::string bytes = Pattern((3 << 20) + 12345);
  work_.SetFile("map.npy", bytes);
  const v1::Job job = RunToItsEnd("a");
  std::vector<v1::ArtifactChunk> chunks;
  const grpc::Status status = Download(job.name(), "map.npy", &chunks);
  ASSERT_TRUE(status.ok()) << status.error_message();
  std::string received;
  for (const v1::ArtifactChunk& chunk : chunks) {
    EXPECT_EQ(chunk.offset(), received.size());
    EXPECT_LE(chunk.data().size(), 1u << 20);
    EXPECT_EQ(chunk.total_bytes(), bytes.size());
    EXPECT_EQ(chunk.sha256(), job.artifacts(0).sha256());
    received += chunk.data();
  }
  EXPECT_TRUE(received == bytes);
}

TEST_F(ArtifactCallsTest, EmptyFileIsOneEmptyChunk) {
  work_.SetFile("map.npy", "");
  const v1::Job job = RunToItsEnd("a");
  std::vector<v1::ArtifactChunk> chunks;
  ASSERT_TRUE(Download(job.name(), "map.npy", &chunks).ok());
  ASSERT_EQ(chunks.size(), 1u);
  EXPECT_EQ(chunks[0].total_bytes(), 0u);
}

TEST_F(ArtifactCallsTest, PartsOfAFileAreRead) {
  const std::string bytes = Pattern((1 << 20) + 10);
  work_.SetFile("map.npy", bytes);
  const v1::Job job = RunToItsEnd("a");
  v1::ArtifactChunk chunk;
  ASSERT_TRUE(Read(job.name(), "map.npy", 0, 0, &chunk).ok());
  EXPECT_TRUE(chunk.data() == bytes.substr(0, 1 << 20));
  ASSERT_TRUE(Read(job.name(), "map.npy", 1 << 20, 100, &chunk).ok());
  EXPECT_TRUE(chunk.data() == bytes.substr(1 << 20));
  ASSERT_TRUE(Read(job.name(), "map.npy", bytes.size(), 100, &chunk).ok());
  EXPECT_EQ(chunk.data(), "");
  EXPECT_EQ(Read(job.name(), "map.npy", bytes.size() + 1, 1, &chunk).error_code(),
            StatusCode::OUT_OF_RANGE);
  EXPECT_EQ(Read(job.name(), "map.npy", ~uint64_t{0}, 1, &chunk).error_code(),
            StatusCode::OUT_OF_RANGE);
  EXPECT_EQ(Read(job.name(), "map.npy", 0, (1 << 20) + 1, &chunk).error_code(),
            StatusCode::INVALID_ARGUMENT);
}

TEST_F(ArtifactCallsTest, OnlyTheFilesOfTheResultAreGiven) {
  const v1::Job job = RunToItsEnd("a");
  v1::ArtifactChunk chunk;
  EXPECT_EQ(Read(job.name(), "request.json", 0, 0, &chunk).error_code(), StatusCode::NOT_FOUND);
  for (const char* name : {"../request.json", "..", "", "/etc/passwd", "a/b"}) {
    std::vector<v1::ArtifactChunk> chunks;
    EXPECT_EQ(Download(job.name(), name, &chunks).error_code(), StatusCode::INVALID_ARGUMENT);
  }
}

TEST_F(ArtifactCallsTest, ResultThatWasSwappedForALinkIsNotFollowed) {
  const v1::Job job = RunToItsEnd("a");
  const auto file = folder_.path() / "state/jobs/000001/result/uniformity.json";
  std::filesystem::remove(file);
  std::filesystem::create_symlink("/etc/passwd", file);
  v1::ArtifactChunk chunk;
  EXPECT_EQ(Read(job.name(), "uniformity.json", 0, 0, &chunk).error_code(),
            StatusCode::PERMISSION_DENIED);
}

TEST_F(ArtifactCallsTest, JobWithoutAResultSaysSo) {
  const v1::Job created = CreateOk("a");
  v1::RunResult result;
  v1::ArtifactChunk chunk;
  std::vector<v1::ArtifactChunk> chunks;
  EXPECT_EQ(Result(created.name(), &result).error_code(), StatusCode::FAILED_PRECONDITION);
  EXPECT_EQ(Read(created.name(), "a", 0, 0, &chunk).error_code(), StatusCode::FAILED_PRECONDITION);
  EXPECT_EQ(Download(created.name(), "a", &chunks).error_code(), StatusCode::FAILED_PRECONDITION);
  EXPECT_EQ(Result("jobs/000009", &result).error_code(), StatusCode::NOT_FOUND);
}

TEST_F(ArtifactCallsTest, ResultIsTheMessageThatWasWritten) {
  v1::RunResult result;
  const v1::Job job = RunToItsEnd("a");
  const grpc::Status status = Result(job.name(), &result);
  ASSERT_TRUE(status.ok()) << status.error_message();
  EXPECT_THAT(result.files(), testing::ElementsAre("uniformity.json"));
}

TEST_F(ArtifactCallsTest, ClientThatNeverReadsDoesNotHoldUpOthers) {
  work_.SetFile("map.npy", Pattern(8 << 20));
  const v1::Job job = RunToItsEnd("a");
  v1::DownloadArtifactRequest request;
  request.set_name(job.name());
  request.set_artifact("map.npy");
  std::vector<std::unique_ptr<CallContext>> contexts;
  std::vector<std::unique_ptr<grpc::ClientReader<v1::ArtifactChunk>>> idle;
  for (int i = 0; i < 8; ++i) {
    contexts.push_back(std::make_unique<CallContext>());
    idle.push_back(stub_->DownloadArtifact(contexts.back().get(), request));
  }
  v1::ArtifactChunk chunk;
  EXPECT_TRUE(Read(job.name(), "map.npy", 0, 0, &chunk).ok());
  for (int i = 0; i < 8; ++i) {
    contexts[i]->TryCancel();
    EXPECT_EQ(idle[i]->Finish().error_code(), StatusCode::CANCELLED);
  }
}

}  // namespace
}  // namespace eyebox::service
