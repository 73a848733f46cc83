// One reading from several pixels around an axis, with how far each part of them looks from it.
#ifndef EYEBOX_FIT_SCATTER_PIXEL_READING_H_
#define EYEBOX_FIT_SCATTER_PIXEL_READING_H_

#include <cstddef>
#include <vector>

#include "fit/scatter/glare_series.h"

namespace eyebox::fit {

// A pixel sees the mean over its area, all of which is sensitive: nine points of it stand for it.
class PixelReading {
 public:
  // Points are told apart by steps of `step_px` in their distance from the axis.
  explicit PixelReading(double step_px) : step_px_(step_px) {}

  // Middle of the pixel from the axis; luminance and its variance.
  void Add(double x_px, double y_px, double luminance, double variance);
  bool empty() const { return pixels_ == 0; }
  // Mean luminance, its noise, and offsets; pattern and diameter are left. Not of an empty one.
  GlareReading Finish(double pitch_deg) const;

 private:
  struct Bin {
    double share = 0;
    double square_px = 0;  // sum of share times squared distance
  };

  double step_px_;
  size_t pixels_ = 0;
  double luminance_ = 0;  // sums over the pixels
  double variance_ = 0;
  std::vector<Bin> bins_;  // from `first_` on
  size_t first_ = 0;
};

}  // namespace eyebox::fit

#endif  // EYEBOX_FIT_SCATTER_PIXEL_READING_H_
