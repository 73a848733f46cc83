// Some rows of an image.
#ifndef EYEBOX_OPTICS_REDUCE_ROWS_H_
#define EYEBOX_OPTICS_REDUCE_ROWS_H_

#include <algorithm>

#include "capture/base/image.h"

namespace eyebox::optics {

struct Rows {
  int first = 0;
  int end = 0;  // one past the last

  int count() const { return end - first; }
  // With `reach` more on either side, as far as an image of `height` goes.
  Rows Widened(int reach, int height) const {
    return {std::max(first - reach, 0), std::min(end + reach, height)};
  }
};

inline Rows AllRows(ImageSize size) { return {0, size.height_px}; }

template <typename T>
Image<T> CropRows(const Image<T>& image, Rows rows) {
  const int width = image.size().width_px;
  Image<T> cropped = Image<T>::Unwritten({width, rows.count()});
  const auto source = image.pixels().subspan(static_cast<size_t>(rows.first) * width);
  std::copy_n(source.begin(), cropped.pixels().size(), cropped.pixels().begin());
  return cropped;
}

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_REDUCE_ROWS_H_
