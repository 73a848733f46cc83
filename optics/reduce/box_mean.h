// The mean over a square window of same-colour neighbours, invalid pixels left out.
#ifndef EYEBOX_OPTICS_REDUCE_BOX_MEAN_H_
#define EYEBOX_OPTICS_REDUCE_BOX_MEAN_H_

#include <cstddef>
#include <span>
#include <vector>

#include "capture/base/image.h"
#include "optics/reduce/rows.h"

namespace eyebox::optics {

// Window of (2 radius + 1)^2 pixels, `step_px` apart in x and y. NaN in `image` is left out; NaN in
// the result where the window holds nothing. [height, width].
Image<float> BoxMean(const Image<float>& image, int radius, int step_px);

// The same row by row, bit by bit, with the rows that a window spans in memory and no others.
class BoxMeanRows {
 public:
  BoxMeanRows(int width_px, int radius, int step_px);

  // How many rows above and below a row its mean takes in.
  int reach() const { return radius_ * step_px_; }
  // Row y, after row y - 1.
  void Push(int y, std::span<const float> row);
  // Of row y over the rows `within`; those in reach of y must have been pushed, and none beyond.
  void Mean(int y, Rows within, std::span<float> mean);

 private:
  // Sum and number of the valid pixels of each horizontal window of one row.
  struct RowSums {
    std::vector<float> sum;
    std::vector<float> count;
  };

  void SumFiveRows(int y);
  void SumRows(int y, Rows within);

  int radius_;
  int step_px_;
  std::vector<RowSums> ring_;
  RowSums window_;
  // A row with zeros on either side.
  std::vector<float> padded_;
  std::vector<float> padded_count_;
};

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_REDUCE_BOX_MEAN_H_
