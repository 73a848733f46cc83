#include "fit/cube/block_compression.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace eyebox::fit {
namespace {

using Colour = std::array<double, 3>;

constexpr int kSide = 4;
constexpr Colour kTop = {31, 63, 31};  // 5, 6 and 5 bits

Colour QuantisedTo565(const Colour& colour) {
  Colour quantised{};
  for (size_t c = 0; c < 3; ++c) quantised[c] = std::round(kTop[c] * colour[c]) / kTop[c];
  return quantised;
}

std::array<Colour, 4> PaletteOf(const Cube3d& cube, const std::vector<size_t>& block) {
  Colour low = {1, 1, 1};
  Colour high = {0, 0, 0};
  for (size_t entry : block) {
    for (size_t c = 0; c < 3; ++c) {
      low[c] = std::min(low[c], cube.entries[entry][c]);
      high[c] = std::max(high[c], cube.entries[entry][c]);
    }
  }
  low = QuantisedTo565(low);
  high = QuantisedTo565(high);
  std::array<Colour, 4> palette{};
  for (size_t k = 0; k < palette.size(); ++k) {
    for (size_t c = 0; c < 3; ++c) {
      palette[k][c] = std::lerp(low[c], high[c], static_cast<double>(k) / 3);
    }
  }
  return palette;
}

Colour Nearest(const std::array<Colour, 4>& palette, const Colour& colour) {
  Colour nearest{};
  double smallest = std::numeric_limits<double>::infinity();
  for (const Colour& candidate : palette) {
    double distance = 0;
    for (size_t c = 0; c < 3; ++c) distance += std::pow(candidate[c] - colour[c], 2);
    if (distance >= smallest) continue;
    smallest = distance;
    nearest = candidate;
  }
  return nearest;
}

}  // namespace

Cube3d CompressBlocks(const Cube3d& cube) {
  Cube3d compressed = cube;
  for (Colour& entry : compressed.entries) {
    for (double& value : entry) value = std::clamp(value, 0.0, 1.0);
  }
  const int size = cube.size;
  for (int blue = 0; blue < size; ++blue) {
    for (int top = 0; top < size; top += kSide) {
      for (int left = 0; left < size; left += kSide) {
        std::vector<size_t> block;
        for (int green = top; green < std::min(top + kSide, size); ++green) {
          for (int red = left; red < std::min(left + kSide, size); ++red) {
            block.push_back(static_cast<size_t>((blue * size + green) * size + red));
          }
        }
        const std::array<Colour, 4> palette = PaletteOf(compressed, block);
        for (size_t entry : block) {
          compressed.entries[entry] = Nearest(palette, compressed.entries[entry]);
        }
      }
    }
  }
  return compressed;
}

}  // namespace eyebox::fit
