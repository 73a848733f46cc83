// Who is served: clients with a certificate of the right authority, and with the token.
#include <gmock/gmock.h>
#include <sys/stat.h>

#include "capture/base/file.h"
#include "service/server/token.h"
#include "tests/service/server/server_fixture.h"
#include "tests/service/server/test_certificates.h"

namespace eyebox::service {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

constexpr char kToken[] = "correct-horse-battery-staple";
constexpr mode_t kOwnerOnly = 0600;

class AccessTest : public testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directories(folder_.path() / "data");
    Write("server.pem", server_key_.certificate);
    Write("server.key", server_key_.key);
    Write("clients.pem", authority_.certificate());
    Write("token", std::string(kToken) + "\n");
    options_.listen = "127.0.0.1:0";
    options_.data = folder_.path() / "data";
    options_.state = folder_.path() / "state";
    options_.access.tls = {Path("server.pem"), Path("server.key"), Path("clients.pem")};
  }
  void TearDown() override { work_.AllowAll(); }

  std::filesystem::path Path(const std::string& name) const { return folder_.path() / name; }
  void Write(const std::string& name, const std::string& content, mode_t mode = kOwnerOnly) {
    ASSERT_TRUE(WriteFileAtomically(Path(name), content).ok());
    ASSERT_EQ(chmod(Path(name).c_str(), mode), 0);
  }
  absl::Status Start() {
    auto server = Server::Start(options_, work_.AsWork(), &clock_);
    if (server.ok()) server_ = *std::move(server);
    return server.status();
  }
  // What a client with these credentials is told when it lists the jobs.
  grpc::Status List(const std::shared_ptr<grpc::ChannelCredentials>& credentials,
                    const std::string& authorization = "") {
    const auto stub = v1::RunService::NewStub(grpc::CreateChannel(server_->address(), credentials));
    CallContext context;
    if (!authorization.empty()) context.AddMetadata("authorization", authorization);
    v1::ListJobsResponse response;
    return stub->ListJobs(&context, {}, &response);
  }
  std::shared_ptr<grpc::ChannelCredentials> Tls(const CertifiedKey& client) const {
    return grpc::SslCredentials({authority_.certificate(), client.key, client.certificate});
  }
  std::string Refusal() {
    const absl::Status status = Start();
    EXPECT_FALSE(status.ok());
    EXPECT_THAT(std::string(status.message()),
                AllOf(HasSubstr("; "), Not(HasSubstr(kToken)), Not(HasSubstr("PRIVATE"))));
    return std::string(status.message());
  }

  TemporaryFolder folder_;
  TestAuthority authority_{"the lab"};
  CertifiedKey server_key_ = authority_.Issue("localhost");
  ManualClock clock_;
  ManualWork work_;
  ServerOptions options_;
  std::unique_ptr<Server> server_;
};

TEST_F(AccessTest, ClientWithACertificateOfTheAuthorityIsServed) {
  ASSERT_TRUE(Start().ok());
  const grpc::Status status = List(Tls(authority_.Issue("a script")));
  EXPECT_TRUE(status.ok()) << status.error_message();
}

TEST_F(AccessTest, ClientWithoutACertificateIsRefused) {
  ASSERT_TRUE(Start().ok());
  EXPECT_EQ(List(grpc::SslCredentials({authority_.certificate(), "", ""})).error_code(),
            grpc::StatusCode::UNAVAILABLE);
}

TEST_F(AccessTest, ClientOfAnotherAuthorityIsRefused) {
  ASSERT_TRUE(Start().ok());
  const TestAuthority stranger("the lab");  // the same name, another key
  EXPECT_EQ(List(Tls(stranger.Issue("a script"))).error_code(), grpc::StatusCode::UNAVAILABLE);
}

TEST_F(AccessTest, ClientWhoseCertificateHasExpiredIsRefused) {
  ASSERT_TRUE(Start().ok());
  EXPECT_EQ(List(Tls(authority_.Issue("a script", -60))).error_code(),
            grpc::StatusCode::UNAVAILABLE);
}

TEST_F(AccessTest, ClientWithoutTlsIsRefused) {
  ASSERT_TRUE(Start().ok());
  EXPECT_EQ(List(grpc::InsecureChannelCredentials()).error_code(), grpc::StatusCode::UNAVAILABLE);
}

TEST_F(AccessTest, TcpWithoutAllThreeFilesIsRefusedNamingTheMissingOne) {
  const TlsFiles all = options_.access.tls;
  options_.access.tls.certificate.clear();
  EXPECT_THAT(Refusal(), HasSubstr("--tls-cert is missing"));
  options_.access.tls = all;
  options_.access.tls.key.clear();
  EXPECT_THAT(Refusal(), HasSubstr("--tls-key is missing"));
  options_.access.tls = all;
  options_.access.tls.client_ca.clear();
  EXPECT_THAT(Refusal(), HasSubstr("--tls-client-ca is missing"));
}

TEST_F(AccessTest, TlsFilesOfAUnixSocketAreRefusedRatherThanIgnored) {
  options_.listen = "unix:" + Path("s").string();
  EXPECT_THAT(Refusal(), HasSubstr("--tls-cert: has no effect on a unix socket"));
}

TEST_F(AccessTest, FilesThatCannotServeAreRefusedNamingThem) {
  Write("server.key", server_key_.key, 0640);
  EXPECT_THAT(Refusal(), AllOf(HasSubstr("server.key"), HasSubstr("chmod 600")));
  Write("server.key", authority_.Issue("localhost").key);
  EXPECT_THAT(Refusal(), AllOf(HasSubstr("server.key"), HasSubstr("is not the key of")));
  Write("server.key", "no key");
  EXPECT_THAT(Refusal(), HasSubstr("server.key: holds no private key"));
  Write("server.key", server_key_.key);
  Write("server.pem", "no certificate");
  EXPECT_THAT(Refusal(), HasSubstr("server.pem: holds no certificate"));
  Write("server.pem", server_key_.certificate + server_key_.certificate.substr(0, 200));
  EXPECT_THAT(Refusal(), HasSubstr("server.pem: certificate 2 is damaged"));
  const CertifiedKey expired = authority_.Issue("localhost", -60);
  Write("server.pem", expired.certificate);
  Write("server.key", expired.key);
  EXPECT_THAT(Refusal(), HasSubstr("server.pem: the certificate has expired"));
}

TEST_F(AccessTest, AClientInPlaceOfItsAuthorityIsRefused) {
  Write("clients.pem", authority_.Issue("a script").certificate);
  EXPECT_THAT(Refusal(), HasSubstr("clients.pem: holds a certificate that may not sign others"));
}

TEST_F(AccessTest, PortThatIsTakenIsSaid) {
  ASSERT_TRUE(Start().ok());
  ServerOptions second = options_;
  second.listen = server_->address();
  second.state = Path("other-state");
  EXPECT_TRUE(absl::IsUnavailable(Server::Start(second, work_.AsWork(), &clock_).status()));
}

class TokenTest : public AccessTest {
 protected:
  void SetUp() override {
    AccessTest::SetUp();
    options_.listen = "unix:" + Path("s").string();
    options_.access = {.tls = {}, .token_file = Path("token")};
  }
  grpc::Status ListOverSocket(const std::string& authorization) {
    return List(grpc::InsecureChannelCredentials(), authorization);
  }
};

TEST_F(TokenTest, UnixSocketServesWhoSendsTheToken) {
  ASSERT_TRUE(Start().ok());
  const grpc::Status status = ListOverSocket(std::string("Bearer ") + kToken);
  EXPECT_TRUE(status.ok()) << status.error_message();
}

TEST_F(TokenTest, UnixSocketWithATokenIsStillForOwnerAndGroup) {
  ASSERT_TRUE(Start().ok());
  struct stat socket = {};
  ASSERT_EQ(stat(Path("s").c_str(), &socket), 0);
  EXPECT_EQ(socket.st_mode & 07777, 0660u);
}

TEST_F(TokenTest, AnyOtherTokenIsUnauthenticated) {
  ASSERT_TRUE(Start().ok());
  const std::string right = std::string("Bearer ") + kToken;
  for (const std::string& sent :
       {std::string(), std::string(kToken), std::string("Bearer "), right + "x",
        right.substr(0, right.size() - 1), "bearer " + std::string(kToken),
        "Bearer " + std::string(4000, 'a')}) {
    const grpc::Status status = ListOverSocket(sent);
    EXPECT_EQ(status.error_code(), grpc::StatusCode::UNAUTHENTICATED) << sent;
    EXPECT_THAT(status.error_message(),
                AllOf(HasSubstr("authorization: "), Not(HasSubstr(kToken))));
  }
}

TEST_F(TokenTest, TlsAsksForTheTokenToo) {
  AccessTest::SetUp();
  options_.access.token_file = Path("token");
  ASSERT_TRUE(Start().ok());
  const auto credentials = Tls(authority_.Issue("a script"));
  EXPECT_EQ(List(credentials).error_code(), grpc::StatusCode::UNAUTHENTICATED);
  EXPECT_TRUE(List(credentials, std::string("Bearer ") + kToken).ok());
}

TEST_F(TokenTest, FileThatOthersMayReadIsRefused) {
  for (const mode_t mode : {0604, 0640, 0620, 0602}) {
    Write("token", kToken, mode);
    EXPECT_THAT(Refusal(), AllOf(HasSubstr("token: holds a secret"), HasSubstr("chmod 600")));
  }
}

TEST_F(TokenTest, FileThatHoldsNoTokenIsRefused) {
  for (const std::string& content :
       {std::string(), std::string("short"), std::string("two words of a token"),
        std::string("sixteen-or-more\nand-a-second-line"), std::string(5000, 'a')}) {
    Write("token", content);
    EXPECT_THAT(Refusal(), HasSubstr("token"));
  }
  options_.access.token_file = folder_.path();
  EXPECT_THAT(Refusal(), HasSubstr("is no file"));
  options_.access.token_file = Path("missing");
  EXPECT_THAT(Refusal(), HasSubstr("missing"));
}

TEST(TokenCompareTest, OnlyTheSameTextIsEqual) {
  const Token token(kToken);
  EXPECT_TRUE(token.Equals(kToken));
  EXPECT_FALSE(token.Equals(""));
  EXPECT_FALSE(token.Equals("correct-horse-battery-staplE"));
}

}  // namespace
}  // namespace eyebox::service
