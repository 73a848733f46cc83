// Packed bytes of a camera to counts. Own code with golden vectors: libraries differ here.
#ifndef EYEBOX_CAPTURE_BASE_UNPACK_H_
#define EYEBOX_CAPTURE_BASE_UNPACK_H_

#include <cstddef>
#include <cstdint>
#include <span>

#include "absl/status/status.h"
#include "capture/base/image.h"
#include "capture/base/pixel_format.h"

namespace eyebox {

// Counts as the sensor gave them, DN, [height, width], right-aligned, mosaic left as it is.
// stride_bytes is the distance between row starts; 0 for rows that follow one another without a
// gap, even within a byte (an odd width of a packed format).
// Errors: InvalidArgument (buffer too short, stride below a row, counts of another size).
absl::Status Unpack(PixelPacking packing, std::span<const std::byte> packed, ImageSize size,
                    size_t stride_bytes, std::span<uint16_t> counts_dn);

// Where the significant bits of a 16-bit word stand.
enum class CountAlignment : uint8_t {
  kUnknown,  // too dark to tell, or of another depth than stated
  kLow,      // as Unpack() promises
  kHigh,     // shifted up by 16 - significant_bits: divide, or ask for another pixel format
};

// Tells by which bits are ever set: low-aligned counts toggle their lowest bits and never exceed
// 2^significant_bits - 1; high-aligned ones never touch the lowest 16 - significant_bits.
// With significant_bits of 16 both are the same, kLow.
CountAlignment DetectAlignment(std::span<const uint16_t> counts_dn, int significant_bits);

}  // namespace eyebox

#endif  // EYEBOX_CAPTURE_BASE_UNPACK_H_
