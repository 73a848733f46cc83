// Health, reflection, the socket.
#include <gmock/gmock.h>
#include <grpcpp/generic/generic_stub.h>
#include <sys/stat.h>

#include "tests/service/server/server_fixture.h"

namespace eyebox::service {
namespace {

using testing::HasSubstr;

// Health and reflection are spoken to in bytes: their protos are in no Debian package.
class ServerTest : public ServerFixture {
 protected:
  static std::string TextOf(const grpc::ByteBuffer& buffer) {
    std::vector<grpc::Slice> slices;
    buffer.Dump(&slices);
    std::string text;
    for (const grpc::Slice& slice : slices) text.append(slice.begin(), slice.end());
    return text;
  }

  // Sends one message and gives the first answer.
  grpc::Status Ask(const std::string& method, const std::string& message, std::string* answer) {
    CallContext context;
    grpc::CompletionQueue queue;
    grpc::GenericStub stub(channel_);
    const auto call = stub.PrepareCall(&context, method, &queue);
    const auto await = [&queue] {
      void* tag = nullptr;
      bool ok = false;
      return queue.Next(&tag, &ok) && ok;
    };
    call->StartCall(nullptr);
    await();
    const grpc::Slice slice(message);
    call->WriteLast(grpc::ByteBuffer(&slice, 1), {}, nullptr);
    await();
    grpc::ByteBuffer received;
    call->Read(&received, nullptr);
    if (await()) *answer = TextOf(received);
    grpc::Status status;
    call->Finish(&status, nullptr);
    await();
    queue.Shutdown();
    return status;
  }

  // HealthCheckRequest {string service = 1}, HealthCheckResponse {enum status = 1}.
  std::string Health(const std::string& service) {
    std::string request;
    if (!service.empty()) {
      request = std::string("\x0a") + static_cast<char>(service.size()) + service;
    }
    std::string answer;
    Ask("/grpc.health.v1.Health/Check", request, &answer);
    return answer;
  }
};

constexpr char kServing[] = "\x08\x01";
constexpr char kService[] = "eyebox.v1.RunService";

TEST_F(ServerTest, HealthIsServing) {
  EXPECT_EQ(Health(""), kServing);
  EXPECT_EQ(Health(kService), kServing);
}

TEST_F(ServerTest, ReflectionListsTheService) {
  // ServerReflectionRequest {string list_services = 7}.
  std::string answer;
  const grpc::Status status =
      Ask("/grpc.reflection.v1alpha.ServerReflection/ServerReflectionInfo", "\x3a\x01*", &answer);
  EXPECT_TRUE(status.ok()) << status.error_message();
  EXPECT_THAT(answer, HasSubstr(kService));
  EXPECT_THAT(answer, HasSubstr("grpc.health.v1.Health"));
}

TEST_F(ServerTest, SocketIsForOwnerAndGroup) {
  struct stat socket = {};
  ASSERT_EQ(stat(Socket().c_str(), &socket), 0);
  EXPECT_TRUE(S_ISSOCK(socket.st_mode));
  EXPECT_EQ(socket.st_mode & 07777, 0660u);
}

TEST_F(ServerTest, ModeOfOtherFilesIsAsBefore) {
  const mode_t before = umask(022);
  umask(before);
  EXPECT_NE(before, mode_t{0117});
}

TEST_F(ServerTest, SecondServerOnTheSocketIsRefusedAndTheFirstLivesOn) {
  ServerOptions options = Options();
  options.state = folder_.path() / "other-state";
  const auto second = Server::Start(options, work_.AsWork(), &clock_);
  EXPECT_TRUE(absl::IsFailedPrecondition(second.status())) << second.status();
  EXPECT_EQ(Health(""), kServing);
}

TEST_F(ServerTest, SecondServerOnTheStateIsRefused) {
  ServerOptions options = Options();
  options.listen += "2";
  const auto second = Server::Start(options, work_.AsWork(), &clock_);
  EXPECT_TRUE(absl::IsFailedPrecondition(second.status())) << second.status();
}

TEST_F(ServerTest, StopIsHarmlessTwice) {
  server_->Stop();
  server_->Stop();
  EXPECT_EQ(Health(""), "");
}

}  // namespace
}  // namespace eyebox::service
