#include "optics/uniformity/smooth_field.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "absl/strings/str_cat.h"
#include "capture/base/status.h"

namespace eyebox::optics {
namespace {

constexpr int kMaximumOrder = 8;

size_t TermCount(int order) { return static_cast<size_t>(order + 1) * (order + 2) / 2; }

// Pairs (a, b) of degrees in x and y, by rising total degree.
std::vector<std::array<int, 2>> Terms(int order) {
  std::vector<std::array<int, 2>> terms;
  for (int degree = 0; degree <= order; ++degree) {
    for (int b = 0; b <= degree; ++b) terms.push_back({degree - b, b});
  }
  return terms;
}

double Normalised(double px, int extent) { return extent > 1 ? 2 * px / (extent - 1) - 1 : 0; }

// P_0 .. P_order by Bonnet's recursion.
void Legendre(double x, int order, double* p) {
  p[0] = 1;
  if (order >= 1) p[1] = x;
  for (int n = 1; n < order; ++n) p[n + 1] = ((2 * n + 1) * x * p[n] - n * p[n - 1]) / (n + 1);
}

// [extent, order + 1]
std::vector<double> LegendreTable(int extent, int order) {
  std::vector<double> table(static_cast<size_t>(extent) * (order + 1));
  for (int i = 0; i < extent; ++i) {
    Legendre(Normalised(i, extent), order, table.data() + static_cast<size_t>(i) * (order + 1));
  }
  return table;
}

Eigen::VectorXd Basis(const SmoothField& field, double x_px, double y_px) {
  double px[kMaximumOrder + 1];
  double py[kMaximumOrder + 1];
  Legendre(Normalised(x_px, field.size.width_px), field.order, px);
  Legendre(Normalised(y_px, field.size.height_px), field.order, py);
  Eigen::VectorXd basis(field.coefficients.size());
  Eigen::Index i = 0;
  for (const auto& [a, b] : Terms(field.order)) basis(i++) = px[a] * py[b];
  return basis;
}

Eigen::Map<const Eigen::MatrixXd> Covariance(const SmoothField& field) {
  const auto n = static_cast<Eigen::Index>(field.coefficients.size());
  return {field.covariance.data(), n, n};
}

Eigen::Map<const Eigen::VectorXd> Coefficients(const SmoothField& field) {
  return {field.coefficients.data(), static_cast<Eigen::Index>(field.coefficients.size())};
}

struct NormalEquations {
  Eigen::MatrixXd matrix;
  Eigen::VectorXd right_side;
  size_t pixels = 0;
};

// Sums of one row over x: the polynomials separate, so that the sums over y need only these.
struct RowSums {
  explicit RowSums(int order) : weight(order + 1, order + 1), value(order + 1) {}
  Eigen::MatrixXd weight;  // sum of w P_a P_a'
  Eigen::VectorXd value;   // sum of w v P_a
  size_t pixels = 0;
};

void SumRow(const MeasuredImage& image, int y, const std::vector<double>& table, int order,
            RowSums& sums) {
  sums.weight.setZero();
  sums.value.setZero();
  sums.pixels = 0;
  const auto value = image.value.row(y);
  const auto variance = image.variance.row(y);
  const auto mask = image.mask.row(y);
  for (size_t x = 0; x < value.size(); ++x) {
    if (mask[x] != 0) continue;
    const double w = 1.0 / variance[x];
    const double* const p = table.data() + x * (order + 1);
    for (int a = 0; a <= order; ++a) {
      const double wp = w * p[a];
      for (int c = 0; c <= a; ++c) sums.weight(c, a) += wp * p[c];
      sums.value(a) += wp * value[x];
    }
    ++sums.pixels;
  }
  sums.weight.triangularView<Eigen::StrictlyLower>() = sums.weight.transpose();
}

NormalEquations SumImage(const MeasuredImage& image, int order) {
  const auto terms = Terms(order);
  const auto n = static_cast<Eigen::Index>(terms.size());
  NormalEquations equations{Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd::Zero(n)};
  const std::vector<double> table = LegendreTable(image.size().width_px, order);
  RowSums row(order);
  double py[kMaximumOrder + 1];
  for (int y = 0; y < image.size().height_px; ++y) {
    SumRow(image, y, table, order, row);
    Legendre(Normalised(y, image.size().height_px), order, py);
    for (Eigen::Index i = 0; i < n; ++i) {
      const auto [a, b] = terms[i];
      equations.right_side(i) += row.value(a) * py[b];
      for (Eigen::Index j = 0; j < n; ++j) {
        equations.matrix(i, j) += row.weight(a, terms[j][0]) * py[b] * py[terms[j][1]];
      }
    }
    equations.pixels += row.pixels;
  }
  return equations;
}

double Chi2(const MeasuredImage& image, const Image<float>& model) {
  double chi2 = 0;
  for (size_t i = 0; i < model.pixels().size(); ++i) {
    if (image.mask.pixels()[i] != 0) continue;
    const double residual = image.value.pixels()[i] - model.pixels()[i];
    chi2 += residual * residual / image.variance.pixels()[i];
  }
  return chi2;
}

}  // namespace

double SmoothField::At(double x_px, double y_px) const {
  return Basis(*this, x_px, y_px).dot(Coefficients(*this));
}

double SmoothField::SigmaAt(double x_px, double y_px) const {
  const Eigen::VectorXd basis = Basis(*this, x_px, y_px);
  return std::sqrt(std::max(basis.dot(Covariance(*this) * basis), 0.0));
}

Image<float> SmoothField::Values() const {
  Image<float> map(size);
  const std::vector<double> table = LegendreTable(size.width_px, order);
  const auto terms = Terms(order);
  double py[kMaximumOrder + 1];
  for (int y = 0; y < size.height_px; ++y) {
    Legendre(Normalised(y, size.height_px), order, py);
    double along_x[kMaximumOrder + 1] = {};
    for (size_t i = 0; i < terms.size(); ++i) {
      along_x[terms[i][0]] += coefficients[i] * py[terms[i][1]];
    }
    const auto row = map.row(y);
    for (size_t x = 0; x < row.size(); ++x) {
      double value = 0;
      for (int a = 0; a <= order; ++a) value += along_x[a] * table[x * (order + 1) + a];
      row[x] = static_cast<float>(value);
    }
  }
  return map;
}

Image<float> SmoothField::Sigmas() const {
  Image<float> map(size);
  for (int y = 0; y < size.height_px; ++y) {
    for (int x = 0; x < size.width_px; ++x) map.at(x, y) = static_cast<float>(SigmaAt(x, y));
  }
  return map;
}

absl::StatusOr<SmoothField> FitSmoothField(const MeasuredImage& image, int order) {
  if (order < 0 || order > kMaximumOrder) {
    return BadInput("smooth field", absl::StrCat("order ", order),
                    absl::StrCat("choose an order from 0 to ", kMaximumOrder));
  }
  const NormalEquations equations = SumImage(image, order);
  const size_t n = TermCount(order);
  if (equations.pixels < n) {
    return Rejected("smooth field",
                    absl::StrCat(equations.pixels, " valid pixels for ", n, " coefficients"),
                    "record exposures with more valid pixels or lower the order");
  }
  const Eigen::LDLT<Eigen::MatrixXd> factors(equations.matrix);
  if (factors.info() != Eigen::Success || !factors.isPositive() || factors.rcond() < 1e-13) {
    return Rejected("smooth field", "the valid pixels do not determine it",
                    "lower the order, or record more of the field");
  }
  const Eigen::VectorXd solution = factors.solve(equations.right_side);
  Eigen::MatrixXd covariance = factors.solve(Eigen::MatrixXd::Identity(n, n));
  SmoothField field;
  field.size = image.size();
  field.order = order;
  field.coefficients.assign(solution.begin(), solution.end());
  const double chi2 = Chi2(image, field.Values());
  field.reduced_chi2 = equations.pixels > n ? chi2 / static_cast<double>(equations.pixels - n) : 0;
  covariance *= std::max(field.reduced_chi2, 1.0);
  field.covariance.assign(covariance.data(), covariance.data() + covariance.size());
  return field;
}

absl::StatusOr<SmoothField> NormaliseAt(const SmoothField& field, double x_px, double y_px) {
  const double reference = field.At(x_px, y_px);
  if (!(reference > 0)) {
    return Rejected(
        "smooth field",
        absl::StrCat("it is ", reference, " at the reference point (", x_px, ", ", y_px, ")"),
        "choose a reference point that is lit");
  }
  // d(c_i / f(x0)) / dc_j = (delta_ij - c_i basis_j(x0) / f(x0)) / f(x0)
  const Eigen::VectorXd scaled = Coefficients(field) / reference;
  const auto n = scaled.size();
  const Eigen::MatrixXd jacobian =
      (Eigen::MatrixXd::Identity(n, n) - scaled * Basis(field, x_px, y_px).transpose()) / reference;
  const Eigen::MatrixXd covariance = jacobian * Covariance(field) * jacobian.transpose();
  SmoothField normalised = field;
  normalised.coefficients.assign(scaled.begin(), scaled.end());
  normalised.covariance.assign(covariance.data(), covariance.data() + covariance.size());
  return normalised;
}

}  // namespace eyebox::optics
