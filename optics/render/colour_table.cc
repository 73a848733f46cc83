#include "optics/render/colour_table.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace eyebox::optics {
namespace {

struct AxisPlace {
  size_t below = 0;
  double weight = 0;  // of the entry above
};

AxisPlace PlaceOnAxis(int size, double position, int weight_bits) {
  const double inside = std::clamp(position, 0.0, size - 1.0);
  const int below = std::min(static_cast<int>(inside), size - 2);
  double weight = inside - below;
  if (weight_bits > 0)
    weight = std::ldexp(std::rint(std::ldexp(weight, weight_bits)), -weight_bits);
  return {static_cast<size_t>(below), weight};
}

}  // namespace

ColourTable SeparableTable(const std::vector<double>& values) {
  ColourTable table{static_cast<int>(values.size()), {}};
  table.entries.reserve(values.size() * values.size() * values.size());
  for (const double blue : values) {
    for (const double green : values) {
      for (const double red : values) table.entries.push_back({red, green, blue});
    }
  }
  return table;
}

Rgb SampleTrilinear(const ColourTable& table, const Rgb& position, int weight_bits) {
  if (std::isnan(position[0] + position[1] + position[2])) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    return {nan, nan, nan};
  }
  const auto size = static_cast<size_t>(table.size);
  const AxisPlace red = PlaceOnAxis(table.size, position[0], weight_bits);
  const AxisPlace green = PlaceOnAxis(table.size, position[1], weight_bits);
  const AxisPlace blue = PlaceOnAxis(table.size, position[2], weight_bits);
  Rgb sum = {0, 0, 0};
  for (size_t corner = 0; corner < 8; ++corner) {
    const size_t up_red = corner & 1;
    const size_t up_green = corner >> 1 & 1;
    const size_t up_blue = corner >> 2;
    const double weight = (up_red != 0 ? red.weight : 1 - red.weight) *
                          (up_green != 0 ? green.weight : 1 - green.weight) *
                          (up_blue != 0 ? blue.weight : 1 - blue.weight);
    if (weight == 0) continue;  // an infinite entry that has no weight must not spoil the sum
    const Rgb& entry =
        table.entries[((blue.below + up_blue) * size + green.below + up_green) * size + red.below +
                      up_red];
    for (size_t channel = 0; channel < 3; ++channel) sum[channel] += weight * entry[channel];
  }
  return sum;
}

}  // namespace eyebox::optics
