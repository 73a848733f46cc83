// What the server says of itself: log, request ids, metrics, health.
#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <mutex>

#include "service/server/observe/metrics.h"
#include "tests/service/server/server_fixture.h"

namespace eyebox::service {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

class ObserveTest : public testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directories(folder_.path() / "data");
    options_.listen = "unix:" + (folder_.path() / "s").string();
    options_.data = folder_.path() / "data";
    options_.state = folder_.path() / "state";
    options_.log = std::make_shared<ServerLog>([this](const std::string& line) {
      const std::lock_guard lock(mutex_);
      lines_.push_back(line);
    });
  }
  void TearDown() override { work_.AllowAll(); }

  void Start() {
    auto server = Server::Start(options_, work_.AsWork(), &clock_);
    ASSERT_TRUE(server.ok()) << server.status();
    server_ = *std::move(server);
    stub_ = v1::RunService::NewStub(
        grpc::CreateChannel(options_.listen, grpc::InsecureChannelCredentials()));
  }
  // The id in the trailing metadata of a call that sends `sent`.
  std::string IdOfCall(const std::string& sent) {
    CallContext context;
    if (!sent.empty()) context.AddMetadata("x-request-id", sent);
    v1::Job job;
    v1::GetJobRequest request;
    request.set_name("jobs/000009");
    EXPECT_EQ(stub_->GetJob(&context, request, &job).error_code(), grpc::StatusCode::NOT_FOUND);
    const auto& trailing = context.GetServerTrailingMetadata();
    EXPECT_EQ(trailing.count("x-request-id"), 1u);
    const auto id = trailing.find("x-request-id");
    return id == trailing.end() ? "" : std::string(id->second.data(), id->second.size());
  }
  std::vector<std::string> Lines() {
    const std::lock_guard lock(mutex_);
    return lines_;
  }

  TemporaryFolder folder_;
  ManualClock clock_;
  ManualWork work_;
  ServerOptions options_;
  std::mutex mutex_;
  std::vector<std::string> lines_;
  std::unique_ptr<Server> server_;
  std::unique_ptr<v1::RunService::Stub> stub_;
};

TEST_F(ObserveTest, EachCallIsALineWithTheIdThatTheClientSees) {
  Start();
  EXPECT_EQ(IdOfCall("script-7.trial_3"), "script-7.trial_3");
  EXPECT_THAT(Lines(),
              Contains(AllOf(HasSubstr(R"("event":"call")"),
                             HasSubstr(R"("request_id":"script-7.trial_3")"),
                             HasSubstr(R"("method":"/eyebox.v1.RunService/GetJob")"),
                             HasSubstr(R"("code":"NOT_FOUND")"), HasSubstr(R"("level":"warning")"),
                             HasSubstr("there is no such job"))));
}

TEST_F(ObserveTest, IdsAreMadeWhereTheClientSendsNoneOrABadOne) {
  Start();
  const std::string first = IdOfCall("");
  const std::string second = IdOfCall("bad id\"}");
  EXPECT_FALSE(first.empty());
  EXPECT_NE(first, second);
  EXPECT_THAT(second, Not(HasSubstr("bad id")));
}

TEST_F(ObserveTest, TokensAreNeverInTheLog) {
  const std::string token = "correct-horse-battery-staple";
  ASSERT_TRUE(WriteFileAtomically(folder_.path() / "token", token).ok());
  std::filesystem::permissions(folder_.path() / "token", std::filesystem::perms::owner_read);
  options_.access.token_file = folder_.path() / "token";
  Start();
  for (const std::string& sent : {token, token + "-wrong"}) {
    CallContext context;
    context.AddMetadata("authorization", "Bearer " + sent);
    v1::ListJobsResponse response;
    stub_->ListJobs(&context, {}, &response);
  }
  const std::vector<std::string> lines = Lines();
  EXPECT_THAT(lines, Contains(HasSubstr("ListJobs")));
  for (const std::string& line : lines) EXPECT_THAT(line, Not(HasSubstr("correct-horse")));
}

// The answer of the HTTP server on that port.
std::string Scrape(int port) {
  const int fd = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address = {};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  EXPECT_EQ(connect(fd, reinterpret_cast<sockaddr*>(&address), sizeof(address)), 0);
  const std::string request = "GET /metrics HTTP/1.0\r\n\r\n";
  EXPECT_EQ(send(fd, request.data(), request.size(), 0), static_cast<ssize_t>(request.size()));
  std::string answer(size_t{1} << 16, '\0');
  size_t length = 0;
  for (ssize_t n = 1; n > 0 && length < answer.size(); length += static_cast<size_t>(n)) {
    n = recv(fd, answer.data() + length, answer.size() - length, 0);
    if (n < 0) n = 0;
  }
  close(fd);
  answer.resize(length);
  return answer;
}

TEST_F(ObserveTest, MetricsAreServedOnTheLoopback) {
  options_.metrics = "127.0.0.1:0";
  Start();
  IdOfCall("");
  const std::string text = Scrape(server_->metrics_port());
  EXPECT_THAT(text,
              AllOf(HasSubstr("eyebox_calls_total{"), HasSubstr("code=\"NOT_FOUND\""),
                    HasSubstr("method=\"/eyebox.v1.RunService/GetJob\""),
                    HasSubstr("eyebox_call_seconds_bucket{"), HasSubstr("eyebox_jobs_queued 0"),
                    HasSubstr("eyebox_serving 1"), HasSubstr("eyebox_disk_free_bytes ")));
}

TEST_F(ObserveTest, MetricsElsewhereThanOnTheLoopbackAreRefused) {
  for (const char* address : {"0.0.0.0:0", "[::]:0", "unix:x", "9090", "lab:9090"}) {
    options_.metrics = address;
    const auto server = Server::Start(options_, work_.AsWork(), &clock_);
    EXPECT_TRUE(absl::IsInvalidArgument(server.status())) << address << server.status();
  }
}

TEST_F(ObserveTest, ALowDiskIsNotServing) {
  options_.metrics = "127.0.0.1:0";
  options_.health.min_free_bytes = UINT64_MAX;
  Start();
  EXPECT_THAT(Scrape(server_->metrics_port()), HasSubstr("eyebox_serving 0"));
  EXPECT_THAT(Lines(), Contains(AllOf(HasSubstr(R"("status":"NOT_SERVING")"),
                                      HasSubstr("GB left, less than"))));
}

TEST(HealthWatchTest, TellsWhenARecorderStallsAndWhenItGoesOn) {
  std::atomic<bool> stalled = true;
  std::mutex mutex;
  std::condition_variable told;
  std::vector<std::string> troubles;
  HealthOptions options;
  options.min_free_bytes = 0;
  options.recorder_stalled = [&] { return stalled.load(); };
  options.period = std::chrono::milliseconds(1);
  const HealthWatch watch({"/"}, options, [&](const std::string& trouble) {
    const std::lock_guard lock(mutex);
    troubles.push_back(trouble);
    told.notify_all();
  });
  std::unique_lock lock(mutex);
  ASSERT_EQ(troubles.size(), 1u) << "told before the watch is made";
  stalled = false;
  told.wait(lock, [&] { return troubles.size() == 2; });
  EXPECT_THAT(troubles, testing::ElementsAre("the recorder stalls", ""));
}

TEST(HealthWatchTest, ADiskThatCannotBeAskedHasNothingFree) {
  EXPECT_EQ(LeastFreeBytes({"/", "/missing/folder"}), 0u);
  EXPECT_GT(LeastFreeBytes({"/"}), 0u);
}

TEST(ServerLogTest, WhatIsWrittenCannotBreakALine) {
  EXPECT_EQ(JsonString("a\"b\\c\n\x01\xff"), R"("a\"b\\c\u000a\u0001?")");
  std::string line;
  ServerLog log([&](const std::string& written) { line = written; });
  log.Write(ServerLog::Level::kInfo, "x", {{"what", "{}%s\n"}});
  EXPECT_THAT(line, HasSubstr(R"("level":"info","event":"x","what":"{}%s\u000a"})"));
}

}  // namespace
}  // namespace eyebox::service
