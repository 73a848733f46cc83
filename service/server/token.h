// The bearer token: read from a file that only its owner may read, compared in constant time.
#ifndef EYEBOX_SERVICE_SERVER_TOKEN_H_
#define EYEBOX_SERVICE_SERVER_TOKEN_H_

#include <array>
#include <cstdint>
#include <filesystem>
#include <string_view>

#include "absl/status/statusor.h"

namespace eyebox::service {

// Keeps the SHA-256 of the token, never the token.
class Token {
 public:
  explicit Token(std::string_view token) : digest_(DigestOf(token)) {}
  // How long it takes says nothing of how much agrees.
  bool Equals(std::string_view sent) const;

 private:
  using Digest = std::array<uint8_t, 32>;
  static Digest DigestOf(std::string_view text);
  Digest digest_;
};

// One line of 16 to 4096 visible ASCII characters. Errors: those of ReadSecretFile;
// InvalidArgument naming the file, never what it holds.
absl::StatusOr<Token> ReadToken(const std::filesystem::path& file);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_SERVER_TOKEN_H_
