#include "service/artifacts.h"

#include <openssl/sha.h>

#include <array>

#include "capture/base/file.h"
#include "capture/base/npy.h"
#include "capture/base/status.h"

namespace eyebox::service {

std::string Sha256(std::string_view bytes) {
  std::array<unsigned char, SHA256_DIGEST_LENGTH> digest;
  SHA256(reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size(), digest.data());
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text;
  for (const unsigned char byte : digest) {
    text.push_back(kDigits[byte >> 4]);
    text.push_back(kDigits[byte & 15]);
  }
  return text;
}

absl::StatusOr<v1::MapFile> WriteMap(const std::filesystem::path& folder, std::string_view file,
                                     std::string_view name, std::string_view unit,
                                     const Image<float>& map) {
  v1::MapFile description;
  description.set_name(std::string(name));
  description.set_unit(std::string(unit));
  description.set_width_px(map.size().width_px);
  description.set_height_px(map.size().height_px);
  if (folder.empty()) return description;
  const std::string bytes = EncodeNpy(map);
  EYEBOX_RETURN_IF_ERROR(WriteFileAtomically(folder / file, bytes));
  description.set_file(std::string(file));
  description.set_sha256(Sha256(bytes));
  return description;
}

}  // namespace eyebox::service
