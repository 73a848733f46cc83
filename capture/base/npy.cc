#include "capture/base/npy.h"

#include <bit>
#include <cstdio>
#include <cstring>
#include <string_view>

#include "capture/base/file.h"
#include "capture/base/status.h"

namespace eyebox {
namespace {

static_assert(std::endian::native == std::endian::little);

constexpr std::string_view kMagic("\x93NUMPY\x01\x00", 8);
constexpr size_t kAlignment = 64;

std::string Header(ImageSize size) {
  std::string text = "{'descr': '<f4', 'fortran_order': False, 'shape': (" +
                     std::to_string(size.height_px) + ", " + std::to_string(size.width_px) + "), }";
  const size_t unpadded = kMagic.size() + sizeof(uint16_t) + text.size() + 1;
  text.append((kAlignment - unpadded % kAlignment) % kAlignment, ' ').push_back('\n');
  return text;
}

absl::StatusOr<ImageSize> ParseHeader(const std::string& file, const std::string& text) {
  ImageSize size;
  if (std::sscanf(text.c_str(), "{'descr': '<f4', 'fortran_order': False, 'shape': (%d, %d), }",
                  &size.height_px, &size.width_px) != 2 ||
      size.height_px <= 0 || size.width_px <= 0) {
    return BadInput(file, "is not a two-dimensional little-endian float32 array in C order",
                    "save it with numpy.save(file, map.astype('<f4'))");
  }
  return size;
}

}  // namespace

std::string EncodeNpy(const Image<float>& map) {
  const std::string header = Header(map.size());
  const auto header_bytes = static_cast<uint16_t>(header.size());
  std::string bytes(kMagic);
  bytes.append(reinterpret_cast<const char*>(&header_bytes), sizeof(header_bytes));
  bytes.append(header);
  bytes.append(reinterpret_cast<const char*>(map.pixels().data()), map.pixels().size_bytes());
  return bytes;
}

absl::StatusOr<Image<float>> ReadNpy(const std::filesystem::path& file) {
  EYEBOX_ASSIGN_OR_RETURN(const std::string bytes, ReadWholeFile(file, size_t{1} << 30));
  uint16_t header_bytes = 0;
  const size_t prefix = kMagic.size() + sizeof(header_bytes);
  if (bytes.size() < prefix || !std::string_view(bytes).starts_with(kMagic)) {
    return BadInput(file.string(), "is not an NPY file of version 1.0", "give a .npy map");
  }
  std::memcpy(&header_bytes, bytes.data() + kMagic.size(), sizeof(header_bytes));
  EYEBOX_ASSIGN_OR_RETURN(
      const ImageSize size,
      ParseHeader(file.string(), bytes.substr(std::min(prefix, bytes.size()), header_bytes)));
  Image<float> map(size);
  if (bytes.size() != prefix + header_bytes + map.pixels().size_bytes()) {
    return Corrupt(file.string(), "its length does not match the shape it states",
                   "copy or compute it again");
  }
  std::memcpy(map.pixels().data(), bytes.data() + prefix + header_bytes, map.pixels().size_bytes());
  return map;
}

}  // namespace eyebox
