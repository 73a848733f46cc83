#include "optics/uniformity/smooth_field.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "absl/strings/str_cat.h"
#include "capture/base/status.h"
#include "optics/uniformity/normal_equations.h"

namespace eyebox::optics {
namespace {

// The terms of the basis that are not 0 at a place.
struct Nonzero {
  std::vector<Eigen::Index> terms;
  std::vector<double> values;
};

Nonzero TermsAt(const FieldBasis& basis, const SideValues& along_x, const SideValues& along_y) {
  Nonzero nonzero;
  const auto& terms = basis.Terms();
  for (size_t i = 0; i < terms.size(); ++i) {
    const int a = terms[i][0] - along_x.first;
    const int b = terms[i][1] - along_y.first;
    if (a < 0 || a >= along_x.count || b < 0 || b >= along_y.count) continue;
    nonzero.terms.push_back(static_cast<Eigen::Index>(i));
    nonzero.values.push_back(along_x.value[a] * along_y.value[b]);
  }
  return nonzero;
}

FieldBasis BasisOf(const SmoothField& field) { return {field.model, field.order, field.size}; }

Eigen::Map<const Eigen::MatrixXd> Covariance(const SmoothField& field) {
  const auto n = static_cast<Eigen::Index>(field.coefficients.size());
  return {field.covariance.data(), n, n};
}

Eigen::Map<const Eigen::VectorXd> Coefficients(const SmoothField& field) {
  return {field.coefficients.data(), static_cast<Eigen::Index>(field.coefficients.size())};
}

double ValueOf(const SmoothField& field, const Nonzero& at) {
  double value = 0;
  for (size_t i = 0; i < at.terms.size(); ++i) {
    value += field.coefficients[at.terms[i]] * at.values[i];
  }
  return value;
}

double SigmaOf(const Eigen::Map<const Eigen::MatrixXd>& covariance, const Nonzero& at) {
  double variance = 0;
  for (size_t i = 0; i < at.terms.size(); ++i) {
    double row = 0;
    for (size_t j = 0; j < at.terms.size(); ++j) {
      row += covariance(at.terms[j], at.terms[i]) * at.values[j];
    }
    variance += row * at.values[i];
  }
  return std::sqrt(std::max(variance, 0.0));
}

Eigen::VectorXd Dense(const Nonzero& at, size_t size) {
  Eigen::VectorXd basis = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(size));
  for (size_t i = 0; i < at.terms.size(); ++i) basis(at.terms[i]) = at.values[i];
  return basis;
}

template <typename Pixel>
Image<float> MapOf(const SmoothField& field, Pixel pixel) {
  const FieldBasis basis = BasisOf(field);
  Image<float> map(field.size);
  std::vector<SideValues> columns;
  for (int x = 0; x < field.size.width_px; ++x) columns.push_back(basis.AlongX(x));
  for (int y = 0; y < field.size.height_px; ++y) {
    const SideValues along_y = basis.AlongY(y);
    const auto row = map.row(y);
    for (size_t x = 0; x < row.size(); ++x) {
      row[x] = static_cast<float>(pixel(TermsAt(basis, columns[x], along_y)));
    }
  }
  return map;
}

absl::Status CheckOrder(FieldModel model, int order) {
  const bool spline = model == FieldModel::kSpline;
  const int least = spline ? 1 : 0;
  const int most = spline ? kMostIntervals : kLargestOrder;
  if (order >= least && order <= most) return absl::OkStatus();
  return BadInput("smooth field", absl::StrCat(spline ? "intervals " : "order ", order),
                  absl::StrCat("choose from ", least, " to ", most));
}

}  // namespace

double SmoothField::At(double x_px, double y_px) const {
  const FieldBasis basis = BasisOf(*this);
  return ValueOf(*this, TermsAt(basis, basis.AlongX(x_px), basis.AlongY(y_px)));
}

double SmoothField::SigmaAt(double x_px, double y_px) const {
  const FieldBasis basis = BasisOf(*this);
  return SigmaOf(Covariance(*this), TermsAt(basis, basis.AlongX(x_px), basis.AlongY(y_px)));
}

Image<float> SmoothField::Values() const {
  return MapOf(*this, [this](const Nonzero& at) { return ValueOf(*this, at); });
}

Image<float> SmoothField::Sigmas() const {
  const auto matrix = Covariance(*this);
  return MapOf(*this, [&matrix](const Nonzero& at) { return SigmaOf(matrix, at); });
}

absl::StatusOr<SmoothField> FitSmoothField(const MeasuredImage& image, FieldModel model,
                                           int order) {
  EYEBOX_RETURN_IF_ERROR(CheckOrder(model, order));
  const FieldBasis basis(model, order, image.size());
  const NormalEquations equations = std::move(SumImage(image, basis, 1).front());
  const size_t n = basis.Terms().size();
  if (equations.pixels < n) {
    return Rejected("smooth field",
                    absl::StrCat(equations.pixels, " valid pixels for ", n, " coefficients"),
                    "record exposures with more valid pixels or lower the order");
  }
  const auto count = static_cast<Eigen::Index>(n);
  const Eigen::LDLT<Eigen::MatrixXd> factors(
      Eigen::Map<const Eigen::MatrixXd>(equations.matrix.data(), count, count));
  if (factors.info() != Eigen::Success || !factors.isPositive() || factors.rcond() < 1e-13) {
    return Rejected("smooth field", "the valid pixels do not determine it",
                    "lower the order, or record more of the field");
  }
  const Eigen::VectorXd solution =
      factors.solve(Eigen::Map<const Eigen::VectorXd>(equations.right_side.data(), count));
  Eigen::MatrixXd covariance = factors.solve(Eigen::MatrixXd::Identity(n, n));
  SmoothField field;
  field.size = image.size();
  field.model = model;
  field.order = order;
  field.coefficients.assign(solution.begin(), solution.end());
  const double chi2 = std::max(equations.Chi2(field.coefficients), 0.0);
  field.reduced_chi2 = equations.pixels > n ? chi2 / static_cast<double>(equations.pixels - n) : 0;
  covariance *= std::max(field.reduced_chi2, 1.0);
  field.covariance.assign(covariance.data(), covariance.data() + covariance.size());
  return field;
}

absl::StatusOr<SmoothField> NormaliseAt(const SmoothField& field, double x_px, double y_px) {
  const FieldBasis functions = BasisOf(field);
  const Nonzero at = TermsAt(functions, functions.AlongX(x_px), functions.AlongY(y_px));
  const double reference = ValueOf(field, at);
  if (!(reference > 0)) {
    return Rejected(
        "smooth field",
        absl::StrCat("it is ", reference, " at the reference point (", x_px, ", ", y_px, ")"),
        "choose a reference point that is lit");
  }
  // d(c_i / f(x0)) / dc_j = (delta_ij - c_i basis_j(x0) / f(x0)) / f(x0)
  const Eigen::VectorXd basis = Dense(at, field.coefficients.size());
  const Eigen::VectorXd scaled = Coefficients(field) / reference;
  const auto n = scaled.size();
  const Eigen::MatrixXd jacobian =
      (Eigen::MatrixXd::Identity(n, n) - scaled * basis.transpose()) / reference;
  const Eigen::MatrixXd covariance = jacobian * Covariance(field) * jacobian.transpose();
  SmoothField normalised = field;
  normalised.coefficients.assign(scaled.begin(), scaled.end());
  normalised.covariance.assign(covariance.data(), covariance.data() + covariance.size());
  return normalised;
}

}  // namespace eyebox::optics
