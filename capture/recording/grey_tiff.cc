#include "capture/recording/grey_tiff.h"

#include <array>
#include <bit>
#include <cstring>
#include <limits>

#include "capture/base/status.h"

namespace eyebox::capture {
namespace {

static_assert(std::endian::native == std::endian::little);

enum FieldType : uint16_t { kShort = 3, kLong = 4, kRational = 5 };

struct Field {
  uint16_t tag;
  uint16_t type;
  uint32_t count;
  uint32_t value;  // or where it stands
};
static_assert(sizeof(Field) == 12);

constexpr size_t kFields = 13;
constexpr uint32_t kDirectory = 8;
constexpr uint32_t kRatio = kDirectory + 2 + kFields * sizeof(Field) + 4;  // one pixel a pixel
constexpr uint32_t kPixels = kRatio + 8;

std::array<Field, kFields> Directory(uint32_t width, uint32_t height) {
  return {{{256, kLong, 1, width},
           {257, kLong, 1, height},
           {258, kShort, 1, 16},  // bits per sample
           {259, kShort, 1, 1},   // not compressed
           {262, kShort, 1, 1},   // black is zero
           {273, kLong, 1, kPixels},
           {277, kShort, 1, 1},  // samples per pixel
           {278, kLong, 1, height},
           {279, kLong, 1, width * height * 2},
           {282, kRational, 1, kRatio},
           {283, kRational, 1, kRatio},
           {296, kShort, 1, 1},    // the resolution has no unit
           {339, kShort, 1, 1}}};  // unsigned
}

template <typename T>
void Put(std::string& bytes, const T& value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof(value));
}

}  // namespace

absl::StatusOr<std::string> EncodeGreyTiff16(const FrameView& frame) {
  const size_t size = frame.pixels_dn.size_bytes();
  if (size == 0 || size > std::numeric_limits<uint32_t>::max() - kPixels) {
    return BadInput("TIFF", "cannot hold a frame of " + std::to_string(size) + " bytes",
                    "export frames of up to 4 GiB");
  }
  std::string bytes;
  bytes.reserve(kPixels + size);
  bytes.append("II*\0", 4);
  Put(bytes, kDirectory);
  Put(bytes, static_cast<uint16_t>(kFields));
  Put(bytes, Directory(static_cast<uint32_t>(frame.size.width_px),
                       static_cast<uint32_t>(frame.size.height_px)));
  Put(bytes, uint32_t{0});  // no further page
  Put(bytes, std::array<uint32_t, 2>{1, 1});
  bytes.append(reinterpret_cast<const char*>(frame.pixels_dn.data()), size);
  return bytes;
}

}  // namespace eyebox::capture
