// Floats of 16, 11 and 10 bits, as colour buffers hold them (Direct3D 11 and Vulkan formats
// R16G16B16A16_FLOAT and R11G11B10_FLOAT): 5 exponent bits with bias 15, denormals, infinity, NaN.
#ifndef EYEBOX_OPTICS_RENDER_SMALL_FLOAT_H_
#define EYEBOX_OPTICS_RENDER_SMALL_FLOAT_H_

#include <cstdint>

namespace eyebox::optics {

struct SmallFloat {
  int mantissa_bits = 0;
  bool has_sign = false;
};
inline constexpr SmallFloat kFloat16 = {10, true};
inline constexpr SmallFloat kFloat11 = {6, false};  // red and green of R11G11B10
inline constexpr SmallFloat kFloat10 = {5, false};  // blue of R11G11B10

enum class Rounding {
  kTruncate,     // towards zero; what is too large becomes the largest finite number
  kNearestEven,  // IEEE 754; what is too large becomes infinity
};

// The value that is read back after `value` was stored. Where there is no sign, negative numbers
// and -infinity become 0. NaN and +infinity stay.
double StoredAs(SmallFloat format, Rounding rounding, double value);

// The bits that are stored: sign (where there is one), exponent, mantissa from the top. NaN is the
// quiet NaN without sign.
uint32_t EncodeSmallFloat(SmallFloat format, Rounding rounding, double value);
// Their value. Bits above the format's are ignored.
double DecodeSmallFloat(SmallFloat format, uint32_t bits);

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_RENDER_SMALL_FLOAT_H_
