// A dense two-dimensional array: row-major, axis order [y, x], origin at the upper left pixel.
#ifndef EYEBOX_CAPTURE_BASE_IMAGE_H_
#define EYEBOX_CAPTURE_BASE_IMAGE_H_

#include <cstddef>
#include <cstdint>
#include <span>

#include "capture/base/large_memory.h"

namespace eyebox {

struct ImageSize {
  int width_px = 0;
  int height_px = 0;
  size_t PixelCount() const { return static_cast<size_t>(width_px) * height_px; }
  friend bool operator==(const ImageSize&, const ImageSize&) = default;
};

template <typename T>
class Image {
 public:
  Image() = default;
  explicit Image(ImageSize size, T fill = T{}) : size_(size), pixels_(size.PixelCount(), fill) {}
  // Each pixel must be written before it is read.
  static Image Unwritten(ImageSize size) {
    Image image;
    image.size_ = size;
    image.pixels_.resize(size.PixelCount());
    return image;
  }

  ImageSize size() const { return size_; }
  bool empty() const { return pixels_.empty(); }
  std::span<T> pixels() { return pixels_; }
  std::span<const T> pixels() const { return pixels_; }
  std::span<T> row(int y) { return pixels().subspan(Offset(0, y), size_.width_px); }
  std::span<const T> row(int y) const { return pixels().subspan(Offset(0, y), size_.width_px); }
  T& at(int x, int y) { return pixels_[Offset(x, y)]; }
  const T& at(int x, int y) const { return pixels_[Offset(x, y)]; }

 private:
  size_t Offset(int x, int y) const { return static_cast<size_t>(y) * size_.width_px + x; }

  ImageSize size_;
  UninitialisedVector<T> pixels_;
};

// Borrowed raw counts of one frame, DN, [height, width]. Valid while its owner lives.
struct FrameView {
  std::span<const uint16_t> pixels_dn;
  ImageSize size;
};

}  // namespace eyebox

#endif  // EYEBOX_CAPTURE_BASE_IMAGE_H_
