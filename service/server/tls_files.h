// The three files of mutual TLS, checked before the server listens.
#ifndef EYEBOX_SERVICE_SERVER_TLS_FILES_H_
#define EYEBOX_SERVICE_SERVER_TLS_FILES_H_

#include <filesystem>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"

namespace eyebox::service {

struct TlsFiles {
  std::filesystem::path certificate;  // PEM, the server's, then those between it and its root
  std::filesystem::path key;          // PEM without a passphrase, readable by its owner alone
  std::filesystem::path client_ca;    // PEM, whoever holds a certificate of these may call
};

// What the files hold.
struct TlsPems {
  std::string certificate;
  std::string key;
  std::string client_ca;
};

// Whether `files` are what the address needs: all for TCP, none for a unix socket.
// Errors: InvalidArgument naming the option.
absl::Status CheckTlsFilesFit(const TlsFiles& files, bool tcp);

// Errors: NotFound, FailedPrecondition (others may read the key), InvalidArgument (no PEM, key of
// another certificate, expired, not a certificate authority), naming the file and never its
// content.
absl::StatusOr<TlsPems> LoadTls(const TlsFiles& files);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_SERVER_TLS_FILES_H_
