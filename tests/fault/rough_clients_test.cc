// Requests that are far too large, and connections that come and go by the thousand.
//
// EYEBOX_CONNECTS=10000 connects so often instead of 2000 times.
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "tests/fault/served_eyebox.h"
#include "tests/fault/server_process.h"
#include "tests/support/temporary_folder.h"

namespace eyebox::service {
namespace {

constexpr int kRequestBytes = 100'000'000;

class RoughClients : public testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directories(folder_ / "data");
    server_ = std::make_unique<ServedEyebox>(folder_.path(), std::vector<std::string>{});
  }

  // Connects to the socket, says `greeting` and goes; false if nobody took the connection.
  bool ConnectAndGo(const std::string& greeting) const {
    const int fd = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_un address = {};
    address.sun_family = AF_UNIX;
    std::strncpy(address.sun_path, server_->Socket().c_str(), sizeof(address.sun_path) - 1);
    bool taken = connect(fd, reinterpret_cast<sockaddr*>(&address), sizeof(address)) == 0;
    if (taken && !greeting.empty()) {
      taken = send(fd, greeting.data(), greeting.size(), MSG_NOSIGNAL) ==
              static_cast<ssize_t>(greeting.size());
    }
    close(fd);
    return taken;
  }

  const TemporaryFolder folder_;
  std::unique_ptr<ServedEyebox> server_;
};

TEST_F(RoughClients, ARequestOfAHundredMegabytesIsRefusedAndDoesNotAddUp) {
  v1::CreateRunRequest request;
  request.set_request_id("large");
  request.set_recording(std::string(kRequestBytes, 'x'));
  const Memory before = MemoryOf(server_->process());
  for (int i = 0; i < 5; ++i) {
    v1::Job job;
    grpc::ClientContext context;
    const grpc::Status status = server_->stub().CreateRun(&context, request, &job);
    EXPECT_EQ(status.error_code(), grpc::StatusCode::RESOURCE_EXHAUSTED) << status.error_message();
  }
  // gRPC takes all of a request in before it refuses it, but then lets go of it: five of them cost
  // no more than two.
  const Memory after = MemoryOf(server_->process());
  EXPECT_LE(after.most_kib, before.most_kib + 2 * (kRequestBytes >> 10));
  std::printf("VmRSS %lld KiB before, %lld KiB after, %lld KiB at most\n",
              static_cast<long long>(before.now_kib), static_cast<long long>(after.now_kib),
              static_cast<long long>(after.most_kib));
  v1::ListJobsResponse jobs;
  grpc::ClientContext context;
  EXPECT_TRUE(server_->stub().ListJobs(&context, {}, &jobs).ok());
  EXPECT_EQ(jobs.jobs_size(), 0);
  EXPECT_TRUE(IsServing(*server_));
  EXPECT_EQ(server_->Stop(), 0);
}

TEST_F(RoughClients, ThousandsOfConnectionsLeaveNoFileOpen) {
  const char* asked = std::getenv("EYEBOX_CONNECTS");
  const int count = asked ? std::atoi(asked) : 2000;
  // Nothing, the beginning of HTTP/2, all of it, and no HTTP/2 at all.
  const std::string preface = "PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n";
  const std::vector<std::string> greetings = {"", preface.substr(0, 9), preface,
                                              "GET / HTTP/1.1\r\n\r\n"};
  EXPECT_TRUE(IsServing(*server_));
  const int before = OpenFilesOf(server_->process());
  int taken = 0;
  int most = 0;
  for (int i = 0; i < count; ++i) {
    taken += ConnectAndGo(greetings[static_cast<size_t>(i) % greetings.size()]) ? 1 : 0;
    if (i % 100 == 0) most = std::max(most, OpenFilesOf(server_->process()));
  }
  EXPECT_EQ(taken, count);
  EXPECT_TRUE(IsServing(*server_));
  const double after = AwaitAtMost(before, [&] { return OpenFilesOf(server_->process()); });
  EXPECT_LE(after, before);
  std::printf("%d connections; files open: %d before, %d at most, %.0f after\n", count, before,
              most, after);
  EXPECT_EQ(server_->Stop(), 0);
}

}  // namespace
}  // namespace eyebox::service
