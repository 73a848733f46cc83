#include "capture/base/unpack.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <string>

#include "capture/base/status.h"

namespace eyebox {
namespace {

static_assert(std::endian::native == std::endian::little, "the loads below are little-endian");

// Each packing says how one group of four pixels comes out of one 64-bit word: four 16-bit lanes,
// first pixel lowest. Shifts and masks on whole words need no vector instructions to be fast.

struct Lsb10 {
  static constexpr size_t kGroupBytes = 5;
  static uint64_t Spread(uint64_t w) {
    return (w & 0x3FF) | (w << 6 & 0x3FF'0000) | (w << 12 & 0x3FF'0000'0000) |
           (w << 18 & 0x3FF'0000'0000'0000);
  }
};

struct Lsb12 {
  static constexpr size_t kGroupBytes = 6;
  static uint64_t Spread(uint64_t w) {
    return (w & 0xFFF) | (w << 4 & 0xFFF'0000) | (w << 8 & 0xFFF'0000'0000) |
           (w << 12 & 0xFFF'0000'0000'0000);
  }
};

// Bytes H0 L10 H1: pixel 0 is H0 << bits | low part of the middle byte, pixel 1 has its high part.
template <int kLowBits>
struct GigE {
  static constexpr size_t kGroupBytes = 6;
  static uint64_t Spread(uint64_t w) {
    constexpr uint64_t kLow = (1u << kLowBits) - 1;
    constexpr uint64_t kHigh = uint64_t{0xFF} << kLowBits;
    return (w << kLowBits & (kHigh | kHigh << 16)) |
           (w << (8 + kLowBits) & (kHigh << 32 | kHigh << 48)) |  //
           (w >> 8 & kLow) | (w << 4 & kLow << 16) | (w & kLow << 32) | (w << 12 & kLow << 48);
  }
};

struct Mipi10 {
  static constexpr size_t kGroupBytes = 5;
  static uint64_t Spread(uint64_t w) {
    return ((w & 0xFF) << 2) | (w >> 32 & 3) |              //
           ((w >> 8 & 0xFF) << 18) | (w >> 34 & 3) << 16 |  //
           ((w >> 16 & 0xFF) << 34) | (w >> 36 & 3) << 32 | ((w >> 24 & 0xFF) << 50) |
           (w >> 38 & 3) << 48;
  }
};

struct Mipi12 {
  static constexpr size_t kGroupBytes = 6;
  static uint64_t Spread(uint64_t w) {
    return ((w & 0xFF) << 4) | (w >> 16 & 0xF) |              //
           ((w >> 8 & 0xFF) << 20) | (w >> 20 & 0xF) << 16 |  //
           ((w >> 24 & 0xFF) << 36) | (w >> 40 & 0xF) << 32 | ((w >> 32 & 0xFF) << 52) |
           (w >> 44 & 0xF) << 48;
  }
};

// `packed` holds at least what `count` pixels take; nothing behind its end is read.
template <typename Packing>
void UnpackGroups(std::span<const std::byte> packed, uint16_t* counts_dn, size_t count) {
  const std::byte* from = packed.data();
  const std::byte* const end = from + packed.size();
  size_t i = 0;
  for (; i + 4 <= count && end - from >= 8; i += 4, from += Packing::kGroupBytes) {
    uint64_t word;
    std::memcpy(&word, from, sizeof word);
    const uint64_t lanes = Packing::Spread(word);
    std::memcpy(counts_dn + i, &lanes, sizeof lanes);
  }
  for (; i < count; i += 4, from += Packing::kGroupBytes) {
    uint64_t word = 0;
    std::memcpy(&word, from, std::min<size_t>(sizeof word, end - from));
    const uint64_t lanes = Packing::Spread(word);
    std::memcpy(counts_dn + i, &lanes, std::min<size_t>(4, count - i) * sizeof(uint16_t));
  }
}

void UnpackRun(PixelPacking packing, std::span<const std::byte> packed, uint16_t* counts_dn,
               size_t count) {
  if (count == 0) return;
  switch (packing) {
    case PixelPacking::kBytes: {
      const auto* from = reinterpret_cast<const uint8_t*>(packed.data());
      for (size_t i = 0; i < count; ++i) counts_dn[i] = from[i];
      return;
    }
    case PixelPacking::kWords:
      std::memcpy(counts_dn, packed.data(), count * sizeof(uint16_t));
      return;
    case PixelPacking::k10Lsb:
      return UnpackGroups<Lsb10>(packed, counts_dn, count);
    case PixelPacking::k12Lsb:
      return UnpackGroups<Lsb12>(packed, counts_dn, count);
    case PixelPacking::k10GigE:
      return UnpackGroups<GigE<2>>(packed, counts_dn, count);
    case PixelPacking::k12GigE:
      return UnpackGroups<GigE<4>>(packed, counts_dn, count);
    case PixelPacking::k10Mipi:
      return UnpackGroups<Mipi10>(packed, counts_dn, count);
    case PixelPacking::k12Mipi:
      return UnpackGroups<Mipi12>(packed, counts_dn, count);
  }
}

absl::Status CheckBuffers(size_t have_bytes, size_t need_bytes, ImageSize size,
                          size_t count_pixels) {
  const std::string frame = "frame of " + std::to_string(size.width_px) + " x " +
                            std::to_string(size.height_px) + " pixels";
  if (size.width_px < 0 || size.height_px < 0 || count_pixels != size.PixelCount()) {
    return BadInput(frame, "is to fill " + std::to_string(count_pixels) + " counts",
                    "give as many counts as the frame has pixels");
  }
  if (have_bytes >= need_bytes) return absl::OkStatus();
  return BadInput(frame,
                  "takes " + std::to_string(need_bytes) + " bytes, the buffer holds " +
                      std::to_string(have_bytes),
                  "check that pixel format and size are those of the camera");
}

}  // namespace

absl::Status Unpack(PixelPacking packing, std::span<const std::byte> packed, ImageSize size,
                    size_t stride_bytes, std::span<uint16_t> counts_dn) {
  const size_t width = static_cast<size_t>(size.width_px);
  const size_t row_bytes = PackedBytes(packing, width);
  if (stride_bytes == 0) {
    const size_t pixels = size.PixelCount();
    EYEBOX_RETURN_IF_ERROR(
        CheckBuffers(packed.size(), PackedBytes(packing, pixels), size, counts_dn.size()));
    UnpackRun(packing, packed, counts_dn.data(), pixels);
    return absl::OkStatus();
  }
  if (stride_bytes < row_bytes) {
    return BadInput("stride of " + std::to_string(stride_bytes) + " bytes",
                    "is less than a row of " + std::to_string(row_bytes),
                    "give the distance between the starts of two rows, or 0");
  }
  const size_t rows = static_cast<size_t>(size.height_px);
  const size_t need = rows == 0 ? 0 : (rows - 1) * stride_bytes + row_bytes;
  EYEBOX_RETURN_IF_ERROR(CheckBuffers(packed.size(), need, size, counts_dn.size()));
  for (size_t y = 0; y < rows; ++y) {
    UnpackRun(packing, packed.subspan(y * stride_bytes, row_bytes), counts_dn.data() + y * width,
              width);
  }
  return absl::OkStatus();
}

CountAlignment DetectAlignment(std::span<const uint16_t> counts_dn, int significant_bits) {
  if (significant_bits >= 16) return CountAlignment::kLow;
  uint16_t ever_set = 0;
  for (const uint16_t count : counts_dn) ever_set |= count;
  const bool low_toggle = (ever_set & ((1u << (16 - significant_bits)) - 1)) != 0;
  const bool above = ever_set >> significant_bits != 0;
  if (low_toggle == above) return CountAlignment::kUnknown;
  return above ? CountAlignment::kHigh : CountAlignment::kLow;
}

}  // namespace eyebox
