#include "optics/reduce/saturation_mask.h"

#include <algorithm>

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
  const ImageSize size = stack.size();
  Image<uint8_t> along_rows(size);
  std::vector<uint8_t> clipped(size.width_px);
  for (int y = 0; y < size.height_px; ++y) {
    const auto counts = stack.saturated_count.row(y);
    std::transform(counts.begin(), counts.end(), clipped.begin(),
                   [](uint8_t n) { return static_cast<uint8_t>(n > 0 ? kSaturated : 0); });
    for (int n = -dilation; n <= dilation; ++n) OrShifted(clipped, n * step_px, along_rows.row(y));
  }
  if (dilation == 0) return along_rows;
  Image<uint8_t> mask(size);
  for (int y = 0; y < size.height_px; ++y) {
    for (int n = -dilation; n <= dilation; ++n) {
      const int row = y + n * step_px;
      if (row < 0 || row >= size.height_px) continue;
      OrShifted(along_rows.row(row), 0, mask.row(y));
    }
  }
  return mask;
}

}  // namespace eyebox::optics
