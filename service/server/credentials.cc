#include "service/server/credentials.h"

#include <grpcpp/security/auth_metadata_processor.h>

#include <optional>
#include <string>
#include <utility>

#include "capture/base/status.h"
#include "service/server/tls_files.h"
#include "service/server/token.h"

namespace eyebox::service {
namespace {

constexpr char kAuthorization[] = "authorization";
constexpr std::string_view kBearer = "Bearer ";

// Refuses a call before any handler sees it, and keeps the token from handlers and logs.
class TokenCheck final : public grpc::AuthMetadataProcessor {
 public:
  explicit TokenCheck(Token token) : token_(std::move(token)) {}
  bool IsBlocking() const override { return false; }

  grpc::Status Process(const InputMetadata& metadata, grpc::AuthContext* /*context*/,
                       OutputMetadata* consumed, OutputMetadata* /*response*/) override {
    if (metadata.count(kAuthorization) != 1) {
      return Refusal("the call carries no token, or several");
    }
    const grpc::string_ref value = metadata.find(kAuthorization)->second;
    const std::string_view sent(value.data(), value.size());
    if (!sent.starts_with(kBearer) || !token_.Equals(sent.substr(kBearer.size()))) {
      return Refusal("the token of the call is not the server's");
    }
    consumed->emplace(kAuthorization, std::string(sent));
    return grpc::Status::OK;
  }

 private:
  static grpc::Status Refusal(std::string_view what) {
    return {grpc::StatusCode::UNAUTHENTICATED,
            Complaint(kAuthorization, what,
                      "send the metadata 'authorization: Bearer TOKEN' with the content of the "
                      "server's --token-file")};
  }

  const Token token_;
};

absl::StatusOr<std::shared_ptr<grpc::ServerCredentials>> TlsCredentials(const TlsFiles& files) {
  EYEBOX_ASSIGN_OR_RETURN(TlsPems pems, LoadTls(files));
  grpc::SslServerCredentialsOptions options(
      GRPC_SSL_REQUEST_AND_REQUIRE_CLIENT_CERTIFICATE_AND_VERIFY);
  options.pem_root_certs = std::move(pems.client_ca);
  options.pem_key_cert_pairs.push_back({std::move(pems.key), std::move(pems.certificate)});
  return grpc::SslServerCredentials(options);
}

}  // namespace

absl::StatusOr<std::shared_ptr<grpc::ServerCredentials>> MakeCredentials(
    const AccessOptions& access, bool tcp) {
  EYEBOX_RETURN_IF_ERROR(CheckTlsFilesFit(access.tls, tcp));
  std::optional<Token> token;
  if (!access.token_file.empty()) {
    EYEBOX_ASSIGN_OR_RETURN(token, ReadToken(access.token_file));
  }
  std::shared_ptr<grpc::ServerCredentials> credentials;
  if (tcp) {
    EYEBOX_ASSIGN_OR_RETURN(credentials, TlsCredentials(access.tls));
  } else if (token) {
    // Bytes on the wire as with insecure ones, which cannot look at metadata.
    credentials = grpc::experimental::LocalServerCredentials(UDS);
  } else {
    credentials = grpc::InsecureServerCredentials();
  }
  if (token) credentials->SetAuthMetadataProcessor(std::make_shared<TokenCheck>(*std::move(token)));
  return credentials;
}

}  // namespace eyebox::service
