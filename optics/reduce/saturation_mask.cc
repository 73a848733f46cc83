#include "optics/reduce/saturation_mask.h"

#include <algorithm>
#include <vector>

#include "optics/reduce/measured_image.h"

namespace eyebox::optics {
namespace {

// target[x] |= source[x + shift], where both exist.
void OrShifted(std::span<const uint8_t> source, int shift, std::span<uint8_t> target) {
  const int width = static_cast<int>(target.size());
  const int last = std::min(width, width - shift);
  for (int x = std::max(0, -shift); x < last; ++x) {
    target[x] = static_cast<uint8_t>(target[x] | source[x + shift]);
  }
}

}  // namespace

Image<uint8_t> SaturationMask(const Stack& stack, int dilation, int step_px) {
  return SaturationMask(stack, dilation, step_px, AllRows(stack.size()));
}

Image<uint8_t> SaturationMask(const Stack& stack, int dilation, int step_px, Rows rows) {
  const auto [width, height] = stack.size();
  const Rows seen = rows.Widened(dilation * step_px, height);
  Image<uint8_t> along_rows({width, seen.count()});
  std::vector<uint8_t> clipped(width);
  for (int y = seen.first; y < seen.end; ++y) {
    const auto counts = stack.saturated_count.row(y);
    std::transform(counts.begin(), counts.end(), clipped.begin(),
                   [](uint8_t n) { return static_cast<uint8_t>(n > 0 ? kSaturated : 0); });
    for (int n = -dilation; n <= dilation; ++n) {
      OrShifted(clipped, n * step_px, along_rows.row(y - seen.first));
    }
  }
  if (dilation == 0) return along_rows;
  Image<uint8_t> mask({width, rows.count()});
  for (int y = rows.first; y < rows.end; ++y) {
    for (int n = -dilation; n <= dilation; ++n) {
      const int row = y + n * step_px;
      if (row < 0 || row >= height) continue;
      OrShifted(along_rows.row(row - seen.first), 0, mask.row(y - rows.first));
    }
  }
  return mask;
}

}  // namespace eyebox::optics
