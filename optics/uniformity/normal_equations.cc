#include "optics/uniformity/normal_equations.h"

namespace eyebox::optics {
namespace {

// Neighbours in x and in y are of different classes.
constexpr int kStepPerRow = 2;

// Sums of one row over x: the functions separate, so that the sums over y need only these.
struct RowSums {
  explicit RowSums(int count)
      : weight(Eigen::MatrixXd::Zero(count, count)), value(Eigen::VectorXd::Zero(count)) {}

  void Clear() {
    weight.setZero();
    value.setZero();
    squares = 0;
    pixels = 0;
  }

  void Add(double v, double w, const SideValues& side) {
    for (int i = 0; i < side.count; ++i) {
      const double wp = w * side.value[i];
      for (int j = 0; j <= i; ++j) weight(side.first + j, side.first + i) += wp * side.value[j];
      value(side.first + i) += wp * v;
    }
    squares += w * v * v;
    ++pixels;
  }

  void Finish() { weight.triangularView<Eigen::StrictlyLower>() = weight.transpose(); }

  Eigen::MatrixXd weight;  // sum of w P_a P_a'
  Eigen::VectorXd value;   // sum of w v P_a
  double squares = 0;
  size_t pixels = 0;
};

void AddRow(const RowSums& row, const SideValues& side, const FieldBasis& basis,
            NormalEquations& sums) {
  const auto& terms = basis.Terms();
  const auto factor = [&side](int b) {
    const int at = b - side.first;
    return at >= 0 && at < side.count ? side.value[at] : 0;
  };
  for (size_t i = 0; i < terms.size(); ++i) {
    const double of_i = factor(terms[i][1]);
    if (of_i == 0) continue;
    sums.right_side(static_cast<Eigen::Index>(i)) += row.value(terms[i][0]) * of_i;
    for (size_t j = 0; j < terms.size(); ++j) {
      const double of_j = factor(terms[j][1]);
      if (of_j == 0) continue;
      sums.matrix(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) +=
          row.weight(terms[i][0], terms[j][0]) * of_i * of_j;
    }
  }
  sums.squares += row.squares;
  sums.pixels += row.pixels;
}

}  // namespace

NormalEquations& NormalEquations::operator+=(const NormalEquations& other) {
  matrix += other.matrix;
  right_side += other.right_side;
  squares += other.squares;
  pixels += other.pixels;
  return *this;
}

NormalEquations& NormalEquations::operator-=(const NormalEquations& other) {
  matrix -= other.matrix;
  right_side -= other.right_side;
  squares -= other.squares;
  pixels -= other.pixels;
  return *this;
}

double NormalEquations::Chi2(const Eigen::VectorXd& coefficients) const {
  const auto n = coefficients.size();
  return squares - 2 * coefficients.dot(right_side.head(n)) +
         coefficients.dot(matrix.topLeftCorner(n, n) * coefficients);
}

std::vector<NormalEquations> SumImage(const MeasuredImage& image, const FieldBasis& basis,
                                      int folds) {
  const auto n = static_cast<Eigen::Index>(basis.Terms().size());
  const auto [width, height] = image.size();
  std::vector<NormalEquations> sums(folds,
                                    {Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd::Zero(n), 0, 0});
  std::vector<SideValues> columns;
  for (int x = 0; x < width; ++x) columns.push_back(basis.AlongX(x));
  std::vector<RowSums> rows(folds, RowSums(basis.CountX()));
  for (int y = 0; y < height; ++y) {
    for (RowSums& row : rows) row.Clear();
    const auto value = image.value.row(y);
    const auto variance = image.variance.row(y);
    const auto mask = image.mask.row(y);
    for (int x = 0; x < width; ++x) {
      if (mask[x] != 0) continue;
      rows[(x + kStepPerRow * y) % folds].Add(value[x], 1.0 / variance[x], columns[x]);
    }
    const SideValues side = basis.AlongY(y);
    for (int fold = 0; fold < folds; ++fold) {
      rows[fold].Finish();
      AddRow(rows[fold], side, basis, sums[fold]);
    }
  }
  return sums;
}

}  // namespace eyebox::optics
