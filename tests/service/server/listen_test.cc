#include "service/server/listen.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>

#include <cstring>

#include "capture/base/file.h"
#include "service/server/server.h"
#include "service/server/store/beneath.h"
#include "tests/service/server/manual_work.h"

namespace eyebox::service {
namespace {

using testing::HasSubstr;

// Bound, and listened on only if `listening`.
OwnedFd MakeSocket(const std::filesystem::path& path, bool listening) {
  OwnedFd fd(socket(AF_UNIX, SOCK_STREAM, 0));
  sockaddr_un address = {};
  address.sun_family = AF_UNIX;
  std::strncpy(address.sun_path, path.c_str(), sizeof(address.sun_path) - 1);
  EXPECT_EQ(bind(fd.get(), reinterpret_cast<sockaddr*>(&address), sizeof(address)), 0);
  EXPECT_TRUE(!listening || listen(fd.get(), 1) == 0);
  return fd;
}

TEST(ListenTest, UnixSocketIsItsPath) {
  EXPECT_EQ(EndpointOf("unix:eyebox.sock")->socket, "eyebox.sock");
  EXPECT_EQ(EndpointOf("unix:/run/eyebox/eyebox.sock")->ForGrpc(), "unix:/run/eyebox/eyebox.sock");
}

TEST(ListenTest, TcpIsHostAndPort) {
  for (const char* address :
       {"localhost:50051", "0.0.0.0:50051", "[::]:50051", "lab-3.example.org:0", "[::1]:65535"}) {
    const auto endpoint = EndpointOf(address);
    ASSERT_TRUE(endpoint.ok()) << endpoint.status();
    EXPECT_TRUE(endpoint->tcp);
    EXPECT_EQ(endpoint->ForGrpc(), address);
  }
}

TEST(ListenTest, WhatIsNeitherIsRefused) {
  for (const char* address :
       {"", "eyebox.sock", "dns:///host:1", "unix-abstract:name", "host:", ":50051", "host:65536",
        "host:-1", "host:+1", "host: 1", "host:1x", "[::1:1", "[]:1", "a b:1", "vsock:1:2",
        "host:99999999999999999999", "::1:50051"}) {
    const auto endpoint = EndpointOf(address);
    EXPECT_TRUE(absl::IsInvalidArgument(endpoint.status())) << address;
    EXPECT_THAT(std::string(endpoint.status().message()), HasSubstr("unix:"));
  }
}

TEST(ListenTest, TcpIsRefusedWithoutMutualTls) {
  const TemporaryFolder folder;
  ManualWork work;
  const ManualClock clock;
  ServerOptions options;
  options.listen = "127.0.0.1:0";
  options.data = folder.path();
  options.state = folder.path() / "state";
  const absl::Status status = Server::Start(options, work.AsWork(), &clock).status();
  EXPECT_TRUE(absl::IsInvalidArgument(status)) << status;
  EXPECT_THAT(std::string(status.message()), HasSubstr("mutual TLS"));
  EXPECT_FALSE(std::filesystem::exists(options.state)) << "refused before anything is made";
}

TEST(ListenTest, PathThatNoSocketCanHaveIsRefused) {
  EXPECT_TRUE(absl::IsInvalidArgument(EndpointOf("unix:").status()));
  EXPECT_TRUE(EndpointOf("unix:" + std::string(107, 'a')).ok());
  EXPECT_TRUE(absl::IsInvalidArgument(EndpointOf("unix:" + std::string(108, 'a')).status()));
}

TEST(ListenTest, SocketOfAKilledServerIsRemoved) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "s";
  { const OwnedFd killed = MakeSocket(path, true); }
  ASSERT_TRUE(std::filesystem::exists(path));
  EXPECT_TRUE(RemoveStaleSocket(path).ok());
  EXPECT_FALSE(std::filesystem::exists(path));
  EXPECT_TRUE(RemoveStaleSocket(path).ok());
}

TEST(ListenTest, SocketThatSomeoneListensOnIsLeftAlone) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "s";
  const OwnedFd alive = MakeSocket(path, true);
  EXPECT_TRUE(absl::IsFailedPrecondition(RemoveStaleSocket(path)));
  EXPECT_TRUE(std::filesystem::exists(path));
}

TEST(ListenTest, FileThatIsNoSocketIsLeftAlone) {
  const TemporaryFolder folder;
  ASSERT_TRUE(WriteFileAtomically(folder.path() / "s", "precious").ok());
  EXPECT_TRUE(absl::IsFailedPrecondition(RemoveStaleSocket(folder.path() / "s")));
  EXPECT_EQ(*ReadWholeFile(folder.path() / "s"), "precious");
}

TEST(ListenTest, FolderThatIsNotThereIsSaid) {
  const TemporaryFolder folder;
  ManualWork work;
  const ManualClock clock;
  ServerOptions options;
  options.listen = "unix:" + (folder.path() / "missing/s").string();
  options.data = folder.path();
  options.state = folder.path() / "state";
  const auto server = Server::Start(options, work.AsWork(), &clock);
  EXPECT_TRUE(absl::IsUnavailable(server.status())) << server.status();
  options.data = folder.path() / "missing";
  EXPECT_TRUE(absl::IsNotFound(Server::Start(options, work.AsWork(), &clock).status()));
}

}  // namespace
}  // namespace eyebox::service
