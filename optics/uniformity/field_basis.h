// Functions over an image that are products of one in x and one in y, which makes sums over its
// pixels quick.
#ifndef EYEBOX_OPTICS_UNIFORMITY_FIELD_BASIS_H_
#define EYEBOX_OPTICS_UNIFORMITY_FIELD_BASIS_H_

#include <array>
#include <vector>

#include "capture/base/image.h"

namespace eyebox::optics {

enum class FieldModel {
  kPolynomial,  // Legendre, P_a(x') P_b(y') with a + b <= size
  kSpline,      // bicubic B-splines over equal intervals, `size` of them along the longer side
};

inline constexpr int kLargestOrder = 12;                   // of polynomials
inline constexpr int kMostIntervals = 16;                  // of splines, along the longer side
inline constexpr int kMostFunctions = kMostIntervals + 3;  // along one side

// Functions along one side that are not 0 at a place: from `first` on.
struct SideValues {
  int first = 0;
  int count = 0;
  std::array<double, kMostFunctions> value{};
};

class FieldBasis {
 public:
  // `size`: order, 0 to kLargestOrder, or intervals, 1 to kMostIntervals. An interval has at least
  // one pixel along either side.
  FieldBasis(FieldModel model, int size, ImageSize image);

  int CountX() const { return count_x_; }
  int CountY() const { return count_y_; }
  // Pairs (a, b) of functions in x and y. Those of a polynomial of lower order come first.
  const std::vector<std::array<int, 2>>& Terms() const { return terms_; }

  SideValues AlongX(double x_px) const { return Along(x_px, image_.width_px, count_x_); }
  SideValues AlongY(double y_px) const { return Along(y_px, image_.height_px, count_y_); }

 private:
  SideValues Along(double px, int extent, int count) const;

  FieldModel model_;
  ImageSize image_;
  int count_x_;
  int count_y_;
  std::vector<std::array<int, 2>> terms_;
};

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_UNIFORMITY_FIELD_BASIS_H_
