#include "optics/uniformity/field_basis.h"

#include <algorithm>
#include <cmath>

namespace eyebox::optics {
namespace {

constexpr int kDegree = 3;

// Of an image side of `extent` pixels beside one of `longer`, in intervals as long as those there.
int Intervals(int extent, int longer, int size) {
  const double share = static_cast<double>(extent) / longer;
  const int wanted = std::max(1, static_cast<int>(std::lround(share * size)));
  return std::min(wanted, std::max(extent - 1, 1));
}

// By rising total degree.
std::vector<std::array<int, 2>> TriangleTerms(int order) {
  std::vector<std::array<int, 2>> terms;
  for (int degree = 0; degree <= order; ++degree) {
    for (int b = 0; b <= degree; ++b) terms.push_back({degree - b, b});
  }
  return terms;
}

std::vector<std::array<int, 2>> ProductTerms(int count_x, int count_y) {
  std::vector<std::array<int, 2>> terms;
  for (int b = 0; b < count_y; ++b) {
    for (int a = 0; a < count_x; ++a) terms.push_back({a, b});
  }
  return terms;
}

// P_0 .. P_(count - 1) at x in [-1, 1], by Bonnet's recursion.
SideValues Legendre(double x, int count) {
  SideValues side{0, count, {}};
  auto& p = side.value;
  p[0] = 1;
  if (count > 1) p[1] = x;
  for (int n = 1; n + 1 < count; ++n) p[n + 1] = ((2 * n + 1) * x * p[n] - n * p[n - 1]) / (n + 1);
  return side;
}

// The four cubic B-splines on unit intervals that are not 0 at `at`, 0 to `intervals`.
SideValues CubicSplines(double at, int intervals) {
  const int interval = std::clamp(static_cast<int>(std::floor(at)), 0, intervals - 1);
  const double t = at - interval;
  const double u = 1 - t;
  SideValues side{interval, kDegree + 1, {}};
  side.value[0] = u * u * u / 6;
  side.value[1] = (3 * t * t * t - 6 * t * t + 4) / 6;
  side.value[2] = (3 * u * u * u - 6 * u * u + 4) / 6;
  side.value[3] = t * t * t / 6;
  return side;
}

}  // namespace

FieldBasis::FieldBasis(FieldModel model, int size, ImageSize image) : model_(model), image_(image) {
  if (model == FieldModel::kPolynomial) {
    count_x_ = count_y_ = size + 1;
    terms_ = TriangleTerms(size);
    return;
  }
  const int longer = std::max(image.width_px, image.height_px);
  count_x_ = Intervals(image.width_px, longer, size) + kDegree;
  count_y_ = Intervals(image.height_px, longer, size) + kDegree;
  terms_ = ProductTerms(count_x_, count_y_);
}

SideValues FieldBasis::Along(double px, int extent, int count) const {
  const double share = extent > 1 ? px / (extent - 1) : 0.5;
  if (model_ == FieldModel::kPolynomial) return Legendre(2 * share - 1, count);
  const int intervals = count - kDegree;
  return CubicSplines(share * intervals, intervals);
}

}  // namespace eyebox::optics
