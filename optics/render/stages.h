// What a renderer does to a colour between the shaded surface and the framebuffer, one step a type.
// A pipeline is a list of such steps (render_pipeline.h).
#ifndef EYEBOX_OPTICS_RENDER_STAGES_H_
#define EYEBOX_OPTICS_RENDER_STAGES_H_

#include <vector>

#include "optics/render/colour_table.h"
#include "optics/render/rgb.h"
#include "optics/render/small_float.h"

namespace eyebox::optics {

// s^-1, scene-linear to display-encoded (HDRP model, eq 4), extended range.
struct EncodeSrgb {
  Rgb Apply(const Rgb& linear) const;
};

// s, display-encoded to scene-linear (eq 3), extended range.
struct DecodeSrgb {
  Rgb Apply(const Rgb& encoded) const;
};

// Fixed exposure e: u / 2^e (eq 2).
struct Exposure {
  double stops = 0;
  Rgb Apply(const Rgb& linear) const;
};

// R11G11B10, HDRP's default colour buffer: 6, 6 and 5 mantissa bits, no sign.
struct PackedFloatBuffer {
  Rounding rounding = Rounding::kTruncate;
  Rgb Apply(const Rgb& linear) const;
};

// R16G16B16A16 with half floats.
struct HalfFloatBuffer {
  Rounding rounding = Rounding::kNearestEven;
  Rgb Apply(const Rgb& linear) const;
};

// 8 bits a channel with the sRGB transfer at writing and reading: linear in, linear out. Clamps to
// [0, 1]; NaN becomes 0, as in Direct3D.
struct SrgbBuffer {
  Rgb Apply(const Rgb& linear) const;
};

// 8 bits a channel of what is already encoded: clamped to [0, 1], rounded to k / 255; NaN becomes
// 0.
struct QuantiseTo8Bits {
  Rgb Apply(const Rgb& encoded) const;
};

// The mean of the dither that is added before rounding to 8 bits: constant, in levels of 1/255.
struct DitherMean {
  double levels = 0;
  Rgb Apply(const Rgb& encoded) const;
};

// Cut to [0, 1] without rounding; NaN becomes 0.
struct Saturate {
  Rgb Apply(const Rgb& value) const;
};

// A grading table on HDRP's axis (log_c.h): External tonemapping, and HDRP's internal table, which
// colour always passes. `weight_bits` as in SampleTrilinear.
struct LogCTable {
  SharedTable table;
  int weight_bits = 0;
  Rgb Apply(const Rgb& linear) const;
};

// External tonemapping as published (HDRP model, section 4): linear in u between knots u*; below
// the first and above the last knot the table's first and last entry.
struct KnotTable {
  SharedTable table;
  std::vector<double> knots_u;  // [n], ascending
  Rgb Apply(const Rgb& linear) const;
};

// A table over [0, 1] with uniform knots: the Post-Processing Stack's strip, sampled with the
// encoded colour; its entries are drive values.
struct UniformTable {
  SharedTable table;
  Rgb Apply(const Rgb& encoded) const;
};

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_RENDER_STAGES_H_
