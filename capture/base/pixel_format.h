// Pixel formats by their PFNC value (GenICam Pixel Format Naming Convention 2.4, the 32-bit codes).
// Names alone deceive: Mono12Packed and Mono12p hold the same counts in different bits.
#ifndef EYEBOX_CAPTURE_BASE_PIXEL_FORMAT_H_
#define EYEBOX_CAPTURE_BASE_PIXEL_FORMAT_H_

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "absl/status/statusor.h"

namespace eyebox {

// How counts lie in bytes. Unless said otherwise the first pixel has the lowest bits.
enum class PixelPacking : uint8_t {
  kBytes,   // 1 byte a pixel
  kWords,   // 2 bytes a pixel, little-endian
  k10Lsb,   // PFNC "10p": a bit stream, 4 pixels in 5 bytes
  k12Lsb,   // PFNC "12p": a bit stream, 2 pixels in 3 bytes
  k10GigE,  // GigE Vision "10Packed": high bytes outside, both low parts in the middle byte
  k12GigE,  // GigE Vision "12Packed": likewise
  k10Mipi,  // MIPI CSI-2 RAW10: 4 high bytes, then their low bits in a fifth (V4L2 "10P")
  k12Mipi,  // MIPI CSI-2 RAW12: 2 high bytes, then their low bits in a third (V4L2 "12P")
};

// The colours of the upper left 2 x 2 pixels, row by row. Never interpolated: planes are counts.
enum class BayerMosaic : uint8_t { kNone, kGrbg, kRggb, kGbrg, kBggr };

struct PixelFormat {
  uint32_t pfnc = 0;
  std::string_view name;
  int significant_bits = 0;
  PixelPacking packing = PixelPacking::kBytes;
  BayerMosaic mosaic = BayerMosaic::kNone;
  friend bool operator==(const PixelFormat&, const PixelFormat&) = default;
};

// Every format that can be unpacked; monochrome first, deepest first.
std::span<const PixelFormat> KnownPixelFormats();

// Errors: InvalidArgument (a format that is not among the known ones, such as RGB8: lists them).
absl::StatusOr<PixelFormat> FindPixelFormat(uint32_t pfnc);
absl::StatusOr<PixelFormat> FindPixelFormat(std::string_view name);

// Bytes that `pixels` pixels in a row take, the last one begun counting whole.
size_t PackedBytes(PixelPacking packing, size_t pixels);

}  // namespace eyebox

#endif  // EYEBOX_CAPTURE_BASE_PIXEL_FORMAT_H_
