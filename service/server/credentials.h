// Who may call: mutual TLS for TCP, and a bearer token that every call must carry.
#ifndef EYEBOX_SERVICE_SERVER_CREDENTIALS_H_
#define EYEBOX_SERVICE_SERVER_CREDENTIALS_H_

#include <grpcpp/security/server_credentials.h>

#include <memory>

#include "absl/status/statusor.h"
#include "service/server/access_options.h"

namespace eyebox::service {

// For a unix socket if `tcp` is false. Errors: InvalidArgument (TCP without all three TLS files,
// TLS files with a unix socket, a secret that others may read), those of LoadTls and ReadToken.
absl::StatusOr<std::shared_ptr<grpc::ServerCredentials>> MakeCredentials(
    const AccessOptions& access, bool tcp);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_SERVER_CREDENTIALS_H_
