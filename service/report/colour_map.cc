#include "service/report/colour_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace eyebox::service::report {

Rgb8 Viridis(double fraction) {
  static constexpr std::array<Rgb8, 11> kStops = {{{68, 1, 84},
                                                   {72, 36, 117},
                                                   {65, 68, 135},
                                                   {53, 95, 141},
                                                   {42, 120, 142},
                                                   {33, 145, 140},
                                                   {34, 168, 132},
                                                   {68, 191, 112},
                                                   {122, 209, 81},
                                                   {189, 223, 38},
                                                   {253, 231, 37}}};
  const double position = std::clamp(fraction, 0.0, 1.0) * (kStops.size() - 1);
  const size_t below = std::min(static_cast<size_t>(position), kStops.size() - 2);
  const double share = position - static_cast<double>(below);
  Rgb8 colour{};
  for (size_t channel = 0; channel < colour.size(); ++channel) {
    const double mixed = (1 - share) * kStops[below][channel] + share * kStops[below + 1][channel];
    colour[channel] = static_cast<uint8_t>(std::lround(mixed));
  }
  return colour;
}

Image<Rgb8> Coloured(const Image<float>& map, Range range) {
  Image<Rgb8> coloured(map.size(), kInvalidColour);
  const double extent = range.maximum - range.minimum;
  const auto values = map.pixels();
  const auto colours = coloured.pixels();
  for (size_t i = 0; i < values.size(); ++i) {
    if (std::isnan(values[i])) continue;
    colours[i] = Viridis(extent > 0 ? (values[i] - range.minimum) / extent : 0.5);
  }
  return coloured;
}

}  // namespace eyebox::service::report
