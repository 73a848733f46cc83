// Transfer functions and small floats.
#include <cmath>
#include <cstdint>

#include "capture/base/random.h"
#include "optics/render/log_c.h"
#include "optics/render/small_float.h"
#include "optics/render/srgb.h"
#include "tests/tools/numerics/worst_case.h"

namespace eyebox::numerics {
namespace {

using optics::Rounding;
using optics::SmallFloat;

// The smallest and largest u that a scene has, and both sides of every break.
std::vector<double> Arguments50(Density density) {
  std::vector<double> values = LogSteps(1e-12, 64, 400 * density.steps);
  for (const double u : {0.04045, 0.0031308, 1.0, 58.85666, 1e-300}) {
    values.insert(values.end(), {std::nextafter(u, 0.0), u, std::nextafter(u, 100.0)});
  }
  return values;
}

Digits50 ToLinear50(const Digits50& x) {
  if (x <= Digits50(0.04045)) return x / Digits50("12.92");
  return pow(Digits50((x + Digits50("0.055")) / Digits50("1.055")), Digits50("2.4"));
}

Digits50 ToSrgb50(const Digits50& x) {
  if (x <= Digits50(0.0031308)) return x * Digits50("12.92");
  return Digits50("1.055") * pow(x, 1 / Digits50("2.4")) - Digits50("0.055");
}

void AddSrgb(Density density, std::vector<Row>& rows) {
  WorstCase to_linear("SrgbToLinear", 1e-15);
  WorstCase to_srgb("LinearToSrgb", 1e-15);
  for (const double x : Arguments50(density)) {
    to_linear.Compare(optics::SrgbToLinear(x), ToLinear50(x), {{"x", x}});
    to_linear.Compare(optics::SrgbToLinear(-x), -ToLinear50(x), {{"x", -x}});
    to_srgb.Compare(optics::LinearToSrgb(x), ToSrgb50(x), {{"x", x}});
    to_srgb.Compare(optics::LinearToSrgb(-x), -ToSrgb50(x), {{"x", -x}});
  }
  rows.push_back(to_linear.row());
  rows.push_back(to_srgb.row());
}

void AddLogC(Density density, std::vector<Row>& rows) {
  const Digits50 gain("5.555556"), bias("0.047996"), scale("0.244161"), shift("0.386036");
  WorstCase to_log_c("LinearToLogC", 1e-15, Measure::kOfScale);
  WorstCase to_linear("LogCToLinear", 1e-14, Measure::kOfScale);
  for (const double u : Arguments50(density)) {
    Digits50 exact = scale * log10(Digits50(gain * u + bias)) + shift;
    if (exact > 1) exact = 1;
    to_log_c.Compare(optics::LinearToLogC(u), exact, {{"u", u}});
  }
  for (int i = 0; i <= 400 * density.steps; ++i) {
    const double log_c = i / (400.0 * density.steps);
    const Digits50 exact = (pow(Digits50(10), Digits50((log_c - shift) / scale)) - bias) / gain;
    to_linear.Compare(optics::LogCToLinear(log_c), exact, {{"log_c", log_c}},
                      static_cast<double>(exact + bias / gain));
  }
  rows.push_back(to_log_c.row());
  rows.push_back(to_linear.row());
}

Digits50 Largest(SmallFloat format) {
  return (2 - ldexp(Digits50(1), -format.mantissa_bits)) * ldexp(Digits50(1), 15);
}

// The rounding of `size` >= 0 as IEEE 754 describes it: to multiples of the step at its exponent.
Digits50 Stored50(SmallFloat format, Rounding rounding, double size) {
  const Digits50 exact = size;
  int exponent = -14;
  while (ldexp(Digits50(1), exponent + 1) <= exact) ++exponent;
  const Digits50 step = ldexp(Digits50(1), exponent - format.mantissa_bits);
  Digits50 steps = floor(Digits50(exact / step));
  const Digits50 rest = exact / step - steps;
  const bool is_odd = floor(Digits50(steps / 2)) * 2 != steps;
  if (rounding == Rounding::kNearestEven && (rest > 0.5 || (rest == 0.5 && is_odd))) steps += 1;
  return steps * step;
}

void CompareStored(SmallFloat format, double size, WorstCase& worst) {
  for (const Rounding rounding : {Rounding::kTruncate, Rounding::kNearestEven}) {
    const double stored = optics::StoredAs(format, rounding, size);
    Digits50 exact = Stored50(format, rounding, size);
    if (exact > Largest(format)) {
      exact = rounding == Rounding::kTruncate ? Largest(format)
                                              : Digits50(std::numeric_limits<double>::infinity());
    }
    worst.Compare(stored, exact, {{"mantissa bits", format.mantissa_bits}, {"value", size}});
  }
}

void AddSmallFloats(Density density, std::vector<Row>& rows) {
  WorstCase stored("StoredAs, half and R11G11B10", 0);
  WorstCase decoded("DecodeSmallFloat(EncodeSmallFloat), all values", 0);
  RandomStream random({11, 11, 10});
  for (const SmallFloat format : {optics::kFloat16, optics::kFloat11, optics::kFloat10}) {
    const uint32_t values = uint32_t{31} << format.mantissa_bits;  // finite ones
    for (uint32_t bits = 0; bits < values; ++bits) {
      const double value = optics::DecodeSmallFloat(format, bits);
      const double next = optics::DecodeSmallFloat(format, bits + 1);
      decoded.Compare(optics::EncodeSmallFloat(format, Rounding::kTruncate, value), bits,
                      {{"mantissa bits", format.mantissa_bits}, {"value", value}});
      if (!std::isfinite(next) || bits % (density.steps > 1 ? 1 : 16) != 0) continue;
      const double middle = value + (next - value) / 2;
      for (const double size : {value, std::nextafter(middle, 0.0), middle,
                                std::nextafter(middle, next), std::nextafter(next, 0.0)}) {
        CompareStored(format, size, stored);
      }
    }
    for (const double size : LogSteps(1e-9, 1e6, 200 * density.steps)) {
      CompareStored(format, size * (1 + random.Uniform()), stored);
    }
  }
  rows.push_back(stored.row());
  rows.push_back(decoded.row());
}

}  // namespace

void AddRenderRows(Density density, std::vector<Row>& rows) {
  AddSrgb(density, rows);
  AddLogC(density, rows);
  AddSmallFloats(density, rows);
}

}  // namespace eyebox::numerics
