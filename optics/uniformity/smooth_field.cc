#include "optics/uniformity/smooth_field.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "capture/base/parallel.h"
#include "capture/base/status.h"
#include "optics/uniformity/normal_equations.h"
#include "optics/uniformity/order_weights.h"

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

std::vector<SideValues> Columns(const FieldBasis& basis, int width_px) {
  std::vector<SideValues> columns;
  for (int x = 0; x < width_px; ++x) columns.push_back(basis.AlongX(x));
  return columns;
}

constexpr size_t kMost = kMostFunctions;

// The field along one row is a sum over the functions in x alone, and so is its variance over pairs
// of them: what each row costs besides a few products a pixel.
class RowOfField {
 public:
  RowOfField(const SmoothField& field, const FieldBasis& basis, int y)
      : field_(field), basis_(basis), along_y_(basis.AlongY(y)) {}

  std::array<double, kMost> Coefficients() const {
    std::array<double, kMost> by_x{};
    ForTerms(
        [&](size_t term, int a, double value) { by_x[a] += field_.coefficients[term] * value; });
    return by_x;
  }

  // [a][b], symmetric.
  std::array<std::array<double, kMost>, kMost> Covariance() const {
    std::array<std::array<double, kMost>, kMost> by_x{};
    const size_t n = field_.coefficients.size();
    ForTerms([&](size_t one, int a, double value) {
      ForTerms([&](size_t other, int b, double other_value) {
        by_x[a][b] += field_.covariance[one * n + other] * value * other_value;
      });
    });
    return by_x;
  }

 private:
  // The terms that are not 0 in this row: term, its function in x, value of its function in y.
  template <typename Visit>
  void ForTerms(const Visit& visit) const {
    const auto& terms = basis_.Terms();
    for (size_t i = 0; i < terms.size(); ++i) {
      const int b = terms[i][1] - along_y_.first;
      if (b >= 0 && b < along_y_.count) visit(i, terms[i][0], along_y_.value[b]);
    }
  }

  const SmoothField& field_;
  const FieldBasis& basis_;
  SideValues along_y_;
};

// Rows on all processors; `row(of_field, columns, pixels)` fills one.
template <typename FillRow>
Image<float> MapOf(const SmoothField& field, const FillRow& row) {
  const FieldBasis basis = BasisOf(field);
  Image<float> map = Image<float>::Unwritten(field.size);
  const std::vector<SideValues> columns = Columns(basis, field.size.width_px);
  ForEachInParallel(field.size.height_px,
                    [&](int y) { row(RowOfField(field, basis, y), columns, map.row(y)); });
  return map;
}

void FillValues(const RowOfField& row, const std::vector<SideValues>& columns,
                std::span<float> pixels) {
  const auto by_x = row.Coefficients();
  for (size_t x = 0; x < pixels.size(); ++x) {
    const SideValues& at = columns[x];
    double value = 0;
    for (int a = 0; a < at.count; ++a) value += by_x[at.first + a] * at.value[a];
    pixels[x] = static_cast<float>(value);
  }
}

void FillSigmas(const RowOfField& row, const std::vector<SideValues>& columns,
                std::span<float> pixels) {
  const auto by_x = row.Covariance();
  for (size_t x = 0; x < pixels.size(); ++x) {
    const SideValues& at = columns[x];
    double variance = 0;
    for (int a = 0; a < at.count; ++a) {
      const double* const with = by_x[at.first + a].data() + at.first;
      double others = 0.5 * with[a] * at.value[a];
      for (int b = 0; b < a; ++b) others += with[b] * at.value[b];
      variance += 2 * others * at.value[a];
    }
    pixels[x] = static_cast<float>(std::sqrt(std::max(variance, 0.0)));
  }
}

absl::Status CheckOrder(FieldModel model, int order) {
  const bool spline = model == FieldModel::kSpline;
  const int least = spline ? 1 : 0;
  const int most = spline ? kMostIntervals : kLargestOrder;
  if (order >= least && order <= most) return absl::OkStatus();
  return BadInput("smooth field", absl::StrCat(spline ? "intervals " : "order ", order),
                  absl::StrCat("choose from ", least, " to ", most));
}

struct Problem {
  FieldModel model;
  int order;
  FieldBasis basis;
  NormalEquations equations;
};

absl::StatusOr<Problem> SumUp(const MeasuredImage& image, FieldModel model, int order) {
  EYEBOX_RETURN_IF_ERROR(CheckOrder(model, order));
  const FieldBasis basis(model, order, image.size());
  Problem problem{model, order, basis, std::move(SumImage(image, basis, 1).front())};
  const size_t n = basis.Terms().size();
  if (problem.equations.pixels >= n) return problem;
  return Rejected("smooth field",
                  absl::StrCat(problem.equations.pixels, " valid pixels for ", n, " coefficients"),
                  "record exposures with more valid pixels or lower the order");
}

struct Solution {
  Eigen::VectorXd coefficients;
  Eigen::MatrixXd inverse;  // of the normal equations with their penalties
  double chi2 = 0;
  double functions = 0;  // trace of what the pixels alone have in the solution
};

absl::StatusOr<Solution> Solve(const NormalEquations& equations,
                               const std::vector<double>& penalties) {
  const auto n = static_cast<Eigen::Index>(equations.right_side.size());
  const Eigen::Map<const Eigen::MatrixXd> matrix(equations.matrix.data(), n, n);
  const auto minimum = MinimiseWithInverse(equations, penalties);
  if (!minimum) {
    return Rejected("smooth field", "the valid pixels do not determine it",
                    "lower the order, or record more of the field");
  }
  Solution solution;
  solution.inverse = Eigen::Map<const Eigen::MatrixXd>(minimum->inverse.data(), n, n);
  solution.coefficients = Eigen::Map<const Eigen::VectorXd>(minimum->coefficients.data(), n);
  solution.chi2 =
      std::max(equations.Chi2({solution.coefficients.data(), equations.right_side.size()}), 0.0);
  solution.functions =
      penalties.empty() ? static_cast<double>(n) : solution.inverse.cwiseProduct(matrix).sum();
  return solution;
}

// `excess`: what a larger model finds left out, over what noise leaves.
SmoothField FieldOf(const MeasuredImage& image, const Problem& problem, const Solution& solution,
                    double excess, const Image<float>& shared_sigma) {
  SmoothField field;
  field.size = image.size();
  field.model = problem.model;
  field.order = problem.order;
  field.effective_functions = solution.functions;
  field.coefficients.assign(solution.coefficients.begin(), solution.coefficients.end());
  const double freedom = static_cast<double>(problem.equations.pixels) - solution.functions;
  field.reduced_chi2 = freedom > 0 ? solution.chi2 / freedom : 0;
  Eigen::MatrixXd covariance = solution.inverse * std::max({field.reduced_chi2, excess, 1.0});
  if (!shared_sigma.empty()) {
    const MeasuredImage shared{shared_sigma, image.variance, image.mask, image.unit, {}};
    const NormalEquations with = std::move(SumImage(shared, problem.basis, 1).front());
    const Eigen::VectorXd moved = solution.inverse * Eigen::Map<const Eigen::VectorXd>(
                                                         with.right_side.data(), covariance.rows());
    covariance += moved * moved.transpose();
  }
  field.covariance.assign(covariance.data(), covariance.data() + covariance.size());
  return field;
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

Image<float> SmoothField::Values() const { return MapOf(*this, FillValues); }

Image<float> SmoothField::Sigmas() const { return MapOf(*this, FillSigmas); }

absl::StatusOr<SmoothField> FitSmoothField(const MeasuredImage& image, FieldModel model, int order,
                                           const Image<float>& shared_sigma,
                                           std::optional<int> larger_order) {
  EYEBOX_ASSIGN_OR_RETURN(const Problem problem, SumUp(image, model, order));
  EYEBOX_ASSIGN_OR_RETURN(Solution solution, Solve(problem.equations, {}));
  double excess = 1;
  if (larger_order) {
    EYEBOX_ASSIGN_OR_RETURN(const Problem larger, SumUp(image, model, *larger_order));
    EYEBOX_ASSIGN_OR_RETURN(const Solution of_larger, Solve(larger.equations, {}));
    excess = (solution.chi2 - of_larger.chi2) / (of_larger.functions - solution.functions);
  }
  return FieldOf(image, problem, solution, excess, shared_sigma);
}

absl::StatusOr<SmoothField> FitWeightedPolynomial(const MeasuredImage& image, int largest_order,
                                                  const Image<float>& shared_sigma) {
  EYEBOX_ASSIGN_OR_RETURN(const Problem problem,
                          SumUp(image, FieldModel::kPolynomial, largest_order));
  EYEBOX_ASSIGN_OR_RETURN(Solution solution, Solve(problem.equations, {}));
  if (largest_order >= kLeastWeightedOrder) {
    EYEBOX_ASSIGN_OR_RETURN(
        solution, Solve(problem.equations, OrderPenalties(problem.equations, problem.basis)));
  }
  return FieldOf(image, problem, solution, 1, shared_sigma);
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
