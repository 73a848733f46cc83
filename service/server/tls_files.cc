#include "service/server/tls_files.h"

#include <openssl/err.h>
#include <openssl/pem.h>
#include <openssl/x509.h>
#include <openssl/x509v3.h>

#include <memory>
#include <utility>
#include <vector>

#include "capture/base/file.h"
#include "capture/base/status.h"
#include "service/server/secret_file.h"

namespace eyebox::service {
namespace {

constexpr size_t kMaxPemBytes = size_t{1} << 20;

template <auto Free>
struct Deleter {
  template <typename T>
  void operator()(T* object) const {
    Free(object);
  }
};
using Bio = std::unique_ptr<BIO, Deleter<BIO_free_all>>;
using Certificate = std::unique_ptr<X509, Deleter<X509_free>>;
using Key = std::unique_ptr<EVP_PKEY, Deleter<EVP_PKEY_free>>;

// Instead of OpenSSL's, which asks at the terminal.
int NoPassphrase(char* /*buffer*/, int /*size*/, int /*writing*/, void* /*data*/) { return -1; }

Bio Reading(const std::string& pem) {
  return Bio(BIO_new_mem_buf(pem.data(), static_cast<int>(pem.size())));
}

absl::StatusOr<std::vector<Certificate>> Certificates(const std::filesystem::path& file,
                                                      const std::string& pem) {
  std::vector<Certificate> all;
  const Bio bio = Reading(pem);
  while (X509* one = PEM_read_bio_X509(bio.get(), nullptr, NoPassphrase, nullptr)) {
    all.emplace_back(one);
  }
  // The end of the file is no error, a damaged certificate is.
  const bool at_end = ERR_GET_REASON(ERR_peek_last_error()) == PEM_R_NO_START_LINE;
  ERR_clear_error();
  if (!all.empty() && at_end) return all;
  return BadInput(file.string(),
                  all.empty() ? "holds no certificate"
                              : "certificate " + std::to_string(all.size() + 1) + " is damaged",
                  "give certificates in PEM form");
}

absl::Status CheckDates(const std::filesystem::path& file, const X509& certificate) {
  if (X509_cmp_current_time(X509_get0_notAfter(&certificate)) < 0) {
    return BadInput(file.string(), "the certificate has expired", "have it renewed");
  }
  if (X509_cmp_current_time(X509_get0_notBefore(&certificate)) > 0) {
    return BadInput(file.string(), "the certificate is not valid yet",
                    "check the clock of this machine, or wait");
  }
  return absl::OkStatus();
}

absl::Status CheckKey(const TlsFiles& files, const std::string& pem, X509* certificate) {
  const Key key(PEM_read_bio_PrivateKey(Reading(pem).get(), nullptr, NoPassphrase, nullptr));
  ERR_clear_error();
  if (!key) {
    return BadInput(files.key.string(), "holds no private key that opens without a passphrase",
                    "give the key of --tls-cert in PEM form");
  }
  const bool fits = X509_check_private_key(certificate, key.get()) == 1;
  ERR_clear_error();
  if (fits) return absl::OkStatus();
  return BadInput(files.key.string(), "is not the key of " + files.certificate.string(),
                  "give the key that the certificate was made for");
}

absl::Status CheckServer(const TlsFiles& files, const TlsPems& pems) {
  EYEBOX_ASSIGN_OR_RETURN(const auto chain, Certificates(files.certificate, pems.certificate));
  EYEBOX_RETURN_IF_ERROR(CheckDates(files.certificate, *chain.front()));
  return CheckKey(files, pems.key, chain.front().get());
}

absl::Status CheckClientCa(const TlsFiles& files, const TlsPems& pems) {
  EYEBOX_ASSIGN_OR_RETURN(const auto authorities, Certificates(files.client_ca, pems.client_ca));
  for (const Certificate& one : authorities) {
    EYEBOX_RETURN_IF_ERROR(CheckDates(files.client_ca, *one));
    if (X509_check_ca(one.get()) == 0) {
      return BadInput(files.client_ca.string(), "holds a certificate that may not sign others",
                      "give the authority that signs the clients, not a client");
    }
  }
  return absl::OkStatus();
}

}  // namespace

absl::Status CheckTlsFilesFit(const TlsFiles& files, bool tcp) {
  const std::pair<const char*, const std::filesystem::path*> options[] = {
      {"--tls-cert", &files.certificate},
      {"--tls-key", &files.key},
      {"--tls-client-ca", &files.client_ca}};
  for (const auto& [name, file] : options) {
    if (tcp && file->empty()) {
      return BadInput(
          "--listen",
          std::string("HOST:PORT is served with mutual TLS only, and ") + name + " is missing",
          "give --tls-cert, --tls-key and --tls-client-ca, or listen on unix:PATH");
    }
    if (!tcp && !file->empty()) {
      return BadInput(name, "has no effect on a unix socket",
                      "leave it out, or listen on HOST:PORT");
    }
  }
  return absl::OkStatus();
}

absl::StatusOr<TlsPems> LoadTls(const TlsFiles& files) {
  TlsPems pems;
  EYEBOX_ASSIGN_OR_RETURN(pems.certificate, ReadWholeFile(files.certificate, kMaxPemBytes));
  EYEBOX_ASSIGN_OR_RETURN(pems.key, ReadSecretFile(files.key, kMaxPemBytes));
  EYEBOX_ASSIGN_OR_RETURN(pems.client_ca, ReadWholeFile(files.client_ca, kMaxPemBytes));
  EYEBOX_RETURN_IF_ERROR(CheckServer(files, pems));
  EYEBOX_RETURN_IF_ERROR(CheckClientCa(files, pems));
  return pems;
}

}  // namespace eyebox::service
