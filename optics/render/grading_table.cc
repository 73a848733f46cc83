#include "optics/render/grading_table.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "optics/render/log_c.h"
#include "optics/render/small_float.h"

namespace eyebox::optics {
namespace {

constexpr double kHsvGuard = 1e-4;

Rgb AsHalf(const Rgb& colour) {
  Rgb stored;
  for (size_t channel = 0; channel < 3; ++channel) {
    stored[channel] = StoredAs(kFloat16, Rounding::kNearestEven, colour[channel]);
  }
  return stored;
}

// Where a light falls on the axis of `table`, in entries.
Rgb LogCPosition(const ColourTable& table, const Rgb& linear) {
  const double last = table.size - 1;
  return {last * LinearToLogC(linear[0]), last * LinearToLogC(linear[1]),
          last * LinearToLogC(linear[2])};
}

}  // namespace

// Written out per channel: with hue h and saturation s of HSV, a channel is v (1 + s (p - 1)),
// where p is 1 for the brightest, 0 for the darkest, and for the middle one its place between them.
// The guard shortens that place and s.
Rgb ThroughHsv(const Rgb& colour, double guard) {
  const auto [darkest, brightest] = std::minmax({colour[0], colour[1], colour[2]});
  const double spread = brightest - darkest;
  const double saturation = spread / (brightest + guard);
  Rgb turned;
  for (size_t channel = 0; channel < 3; ++channel) {
    const double above = colour[channel] - darkest;
    const double place = colour[channel] == brightest ? 1 : 6 * above / (6 * spread + guard);
    turned[channel] = brightest * (1 + saturation * (place - 1));
  }
  return turned;
}

ColourTable GradingTable(int size, const ColourTable* external, const GradingOptions& options) {
  ColourTable outer;
  if (external != nullptr) {
    outer = *external;
    if (options.half_floats) {
      for (Rgb& entry : outer.entries) entry = AsHalf(entry);
    }
  }
  std::vector<double> axis(static_cast<size_t>(size));
  for (int i = 0; i < size; ++i) axis[i] = std::max(LogCToLinear(i / (size - 1.0)), 0.0);
  ColourTable table = SeparableTable(axis);
  for (Rgb& entry : table.entries) {
    if (options.through_hsv) entry = ThroughHsv(entry, kHsvGuard);
    if (external != nullptr) entry = SampleTrilinear(outer, LogCPosition(outer, entry));
    if (options.half_floats) entry = AsHalf(entry);
  }
  return table;
}

}  // namespace eyebox::optics
