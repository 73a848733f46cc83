#include "optics/uniformity/normal_equations.h"

#include <Eigen/Dense>
#include <algorithm>
#include <functional>
#include <utility>

namespace eyebox::optics {
namespace {

// Neighbours in x and in y are of different classes.
constexpr int kStepPerRow = 2;
constexpr double kLeastCondition = 1e-13;

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
    sums.right_side[i] += row.value(terms[i][0]) * of_i;
    for (size_t j = 0; j < terms.size(); ++j) {
      const double of_j = factor(terms[j][1]);
      if (of_j == 0) continue;
      sums.matrix[i * terms.size() + j] += row.weight(terms[i][0], terms[j][0]) * of_i * of_j;
    }
  }
  sums.squares += row.squares;
  sums.pixels += row.pixels;
}

// Scaled to ones on the diagonal, since penalties differ by many orders of magnitude.
struct Factors {
  Eigen::VectorXd unit;
  Eigen::LDLT<Eigen::MatrixXd> scaled;
};

std::optional<Factors> Factorise(const NormalEquations& equations, size_t terms,
                                 const std::vector<double>& penalties) {
  const auto n = static_cast<Eigen::Index>(equations.right_side.size());
  const auto first = static_cast<Eigen::Index>(terms);
  Eigen::MatrixXd matrix =
      Eigen::Map<const Eigen::MatrixXd>(equations.matrix.data(), n, n).topLeftCorner(first, first);
  for (size_t i = 0; i < penalties.size(); ++i) {
    matrix.diagonal()(static_cast<Eigen::Index>(i)) += penalties[i];
  }
  Factors factors;
  factors.unit = matrix.diagonal().cwiseSqrt().cwiseInverse();
  if (!factors.unit.allFinite()) return std::nullopt;
  factors.scaled.compute(factors.unit.asDiagonal() * matrix * factors.unit.asDiagonal());
  const bool determined = factors.scaled.info() == Eigen::Success && factors.scaled.isPositive() &&
                          factors.scaled.rcond() >= kLeastCondition;
  return determined ? std::optional(std::move(factors)) : std::nullopt;
}

std::vector<double> CoefficientsOf(const NormalEquations& equations, const Factors& factors) {
  const Eigen::Map<const Eigen::VectorXd> right_side(equations.right_side.data(),
                                                     factors.unit.size());
  const Eigen::VectorXd coefficients =
      factors.unit.cwiseProduct(factors.scaled.solve(factors.unit.cwiseProduct(right_side)));
  return {coefficients.begin(), coefficients.end()};
}

}  // namespace

NormalEquations& NormalEquations::operator+=(const NormalEquations& other) {
  std::ranges::transform(matrix, other.matrix, matrix.begin(), std::plus());
  std::ranges::transform(right_side, other.right_side, right_side.begin(), std::plus());
  squares += other.squares;
  pixels += other.pixels;
  return *this;
}

NormalEquations& NormalEquations::operator-=(const NormalEquations& other) {
  std::ranges::transform(matrix, other.matrix, matrix.begin(), std::minus());
  std::ranges::transform(right_side, other.right_side, right_side.begin(), std::minus());
  squares -= other.squares;
  pixels -= other.pixels;
  return *this;
}

double NormalEquations::Chi2(std::span<const double> coefficients) const {
  const size_t n = right_side.size();
  double chi2 = squares;
  for (size_t i = 0; i < coefficients.size(); ++i) {
    double row = -2 * right_side[i];
    for (size_t j = 0; j < coefficients.size(); ++j) row += matrix[i * n + j] * coefficients[j];
    chi2 += coefficients[i] * row;
  }
  return chi2;
}

std::optional<std::vector<double>> Minimise(const NormalEquations& equations, size_t terms,
                                            const std::vector<double>& penalties) {
  const auto factors = Factorise(equations, terms, penalties);
  if (!factors) return std::nullopt;
  return CoefficientsOf(equations, *factors);
}

std::optional<Minimum> MinimiseWithInverse(const NormalEquations& equations,
                                           const std::vector<double>& penalties) {
  const auto factors = Factorise(equations, equations.right_side.size(), penalties);
  if (!factors) return std::nullopt;
  const Eigen::MatrixXd inverse =
      factors->unit.asDiagonal() *
      factors->scaled.solve(Eigen::MatrixXd(factors->unit.asDiagonal()));
  return Minimum{CoefficientsOf(equations, *factors),
                 {inverse.data(), inverse.data() + inverse.size()}};
}

std::vector<NormalEquations> SumImage(const MeasuredImage& image, const FieldBasis& basis,
                                      int folds) {
  const size_t n = basis.Terms().size();
  const auto [width, height] = image.size();
  std::vector<NormalEquations> sums(
      folds, {std::vector<double>(n * n, 0), std::vector<double>(n, 0), 0, 0});
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
