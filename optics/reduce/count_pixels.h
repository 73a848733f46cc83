// How many pixels of a mask are of a kind.
#ifndef EYEBOX_OPTICS_REDUCE_COUNT_PIXELS_H_
#define EYEBOX_OPTICS_REDUCE_COUNT_PIXELS_H_

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

namespace eyebox::optics {

// As std::count_if, but counts in bytes as long as they hold the count, which vectorises.
template <typename Is>
size_t CountPixels(std::span<const uint8_t> mask, const Is& is) {
  constexpr size_t kByteHolds = 255;
  size_t total = 0;
  for (size_t begin = 0; begin < mask.size(); begin += kByteHolds) {
    const size_t end = std::min(begin + kByteHolds, mask.size());
    uint8_t count = 0;
    for (size_t i = begin; i < end; ++i)
      count = static_cast<uint8_t>(count + (is(mask[i]) ? 1 : 0));
    total += count;
  }
  return total;
}

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_REDUCE_COUNT_PIXELS_H_
