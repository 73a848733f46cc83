#include "service/server/token.h"

#include <openssl/crypto.h>
#include <openssl/sha.h>

#include <algorithm>
#include <string>

#include "capture/base/status.h"
#include "service/server/secret_file.h"

namespace eyebox::service {
namespace {

constexpr size_t kMinTokenCharacters = 16;
constexpr size_t kMaxTokenCharacters = 4096;

bool IsVisible(char c) { return c > ' ' && c <= '~'; }

}  // namespace

Token::Digest Token::DigestOf(std::string_view text) {
  Digest digest;
  SHA256(reinterpret_cast<const uint8_t*>(text.data()), text.size(), digest.data());
  return digest;
}

bool Token::Equals(std::string_view sent) const {
  const Digest digest = DigestOf(sent);
  return CRYPTO_memcmp(digest.data(), digest_.data(), digest.size()) == 0;
}

absl::StatusOr<Token> ReadToken(const std::filesystem::path& file) {
  EYEBOX_ASSIGN_OR_RETURN(std::string token, ReadSecretFile(file, kMaxTokenCharacters + 2));
  while (!token.empty() && (token.back() == '\n' || token.back() == '\r')) token.pop_back();
  if (token.size() < kMinTokenCharacters || token.size() > kMaxTokenCharacters ||
      !std::ranges::all_of(token, IsVisible)) {
    return BadInput(file.string(), "is not one line of 16 to 4096 visible ASCII characters",
                    "make one with: openssl rand -hex 32");
  }
  return Token(token);
}

}  // namespace eyebox::service
