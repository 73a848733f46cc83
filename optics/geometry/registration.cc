#include "optics/geometry/registration.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "Eigen/Core"
#include "Eigen/QR"
#include "absl/strings/str_cat.h"
#include "capture/base/status.h"

namespace eyebox::optics {
namespace {

constexpr int kHighestOrder = 8;
constexpr double kIndependent = 1e-10;

int TermsOf(int order) { return (order + 1) * (order + 2) / 2; }
bool IsEnough(size_t dots, int order) {
  return 2 * dots >= 3 * static_cast<size_t>(TermsOf(order));
}

// s^i t^j and its derivatives by s and t, in the order of the coefficients.
struct Term {
  double value, by_s, by_t;
};

std::vector<Term> Terms(int order, double s, double t) {
  std::vector<Term> terms;
  const auto power = [](double base, int n) { return n < 0 ? 0.0 : std::pow(base, n); };
  for (int degree = 0; degree <= order; ++degree) {
    for (int j = 0; j <= degree; ++j) {
      const int i = degree - j;
      terms.push_back({power(s, i) * power(t, j), i * power(s, i - 1) * power(t, j),
                       j * power(s, i) * power(t, j - 1)});
    }
  }
  return terms;
}

double Sum(const std::vector<double>& coefficients, const std::vector<Term>& terms,
           double Term::*part) {
  double sum = 0;
  for (size_t i = 0; i < terms.size(); ++i) sum += coefficients[i] * (terms[i].*part);
  return sum;
}

absl::Status Check(std::span<const DisplayedDot> dots, std::optional<int> order) {
  if (order && (*order < 1 || *order > kHighestOrder)) {
    return BadInput("registration", absl::StrCat("order ", *order), "give 1 to 8");
  }
  const int least = order.value_or(1);
  if (!IsEnough(dots.size(), least)) {
    return BadInput("registration", absl::StrCat(dots.size(), " dots for order ", least),
                    absl::StrCat("show at least ", (3 * TermsOf(least) + 1) / 2, " dots"));
  }
  for (size_t i = 0; i < dots.size(); ++i) {
    const DisplayedDot& dot = dots[i];
    if (!std::isfinite(dot.display.x_px + dot.display.y_px + dot.seen.horizontal_deg +
                       dot.seen.vertical_deg)) {
      return BadInput(absl::StrCat("registration, dot ", i + 1), "is not finite",
                      "give four numbers a dot");
    }
  }
  return absl::OkStatus();
}

DisplayMap Normalised(std::span<const DisplayedDot> dots) {
  const auto [left, right] =
      std::ranges::minmax(dots, {}, [](const DisplayedDot& dot) { return dot.display.x_px; });
  const auto [top, bottom] =
      std::ranges::minmax(dots, {}, [](const DisplayedDot& dot) { return dot.display.y_px; });
  DisplayMap map;
  map.centre = {(left.display.x_px + right.display.x_px) / 2,
                (top.display.y_px + bottom.display.y_px) / 2};
  map.scale_px =
      std::max({right.display.x_px - map.centre.x_px, bottom.display.y_px - map.centre.y_px, 1e-9});
  return map;
}

struct Fit {
  DisplayMap map;
  double sum_of_squares = 0;
  double largest = 0;
  double left_out_rms = 0;
};

absl::StatusOr<Fit> FitOrder(std::span<const DisplayedDot> dots, int order) {
  Fit fit;
  fit.map = Normalised(dots);
  fit.map.order = order;
  const auto count = static_cast<Eigen::Index>(dots.size());
  Eigen::MatrixXd design(count, TermsOf(order));
  Eigen::MatrixXd seen(count, 2);
  for (Eigen::Index row = 0; row < count; ++row) {
    const DisplayedDot& dot = dots[static_cast<size_t>(row)];
    const auto terms = Terms(order, (dot.display.x_px - fit.map.centre.x_px) / fit.map.scale_px,
                             (dot.display.y_px - fit.map.centre.y_px) / fit.map.scale_px);
    for (size_t i = 0; i < terms.size(); ++i) {
      design(row, static_cast<Eigen::Index>(i)) = terms[i].value;
    }
    seen.row(row) << dot.seen.horizontal_deg, dot.seen.vertical_deg;
  }
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(design.rows(), design.cols());
  qr.setThreshold(kIndependent);
  qr.compute(design);
  if (qr.rank() < design.cols()) {
    return Rejected("registration", absl::StrCat("the dots do not determine order ", order),
                    "show dots on more rows and columns");
  }
  const Eigen::MatrixXd coefficients = qr.solve(seen);
  const Eigen::MatrixXd residual = seen - design * coefficients;
  const Eigen::MatrixXd q =
      qr.householderQ() * Eigen::MatrixXd::Identity(design.rows(), design.cols());
  const Eigen::ArrayXd kept = 1 - q.rowwise().squaredNorm().array();
  fit.map.horizontal_deg.assign(coefficients.col(0).begin(), coefficients.col(0).end());
  fit.map.vertical_deg.assign(coefficients.col(1).begin(), coefficients.col(1).end());
  fit.sum_of_squares = residual.squaredNorm();
  fit.largest = residual.rowwise().norm().maxCoeff();
  const Eigen::ArrayXXd left_out = residual.array().colwise() / kept;
  fit.left_out_rms = std::sqrt(left_out.square().sum() / (2.0 * static_cast<double>(count)));
  return fit;
}

}  // namespace

FieldAngle DisplayMap::FieldAngleOf(const PixelPoint& display) const {
  const auto terms = Terms(order, (display.x_px - centre.x_px) / scale_px,
                           (display.y_px - centre.y_px) / scale_px);
  return {Sum(horizontal_deg, terms, &Term::value), Sum(vertical_deg, terms, &Term::value)};
}

std::optional<PixelPoint> DisplayMap::DisplayPixelOf(const FieldAngle& angle) const {
  constexpr int kSteps = 50;
  constexpr double kFarthest = 1.5;
  double s = 0;
  double t = 0;
  for (int step = 0; step < kSteps; ++step) {
    const auto terms = Terms(order, s, t);
    const double h = angle.horizontal_deg - Sum(horizontal_deg, terms, &Term::value);
    const double v = angle.vertical_deg - Sum(vertical_deg, terms, &Term::value);
    const double hs = Sum(horizontal_deg, terms, &Term::by_s);
    const double ht = Sum(horizontal_deg, terms, &Term::by_t);
    const double vs = Sum(vertical_deg, terms, &Term::by_s);
    const double vt = Sum(vertical_deg, terms, &Term::by_t);
    const double determinant = hs * vt - ht * vs;
    if (determinant == 0) return std::nullopt;
    const double ds = (h * vt - v * ht) / determinant;
    const double dt = (v * hs - h * vs) / determinant;
    s += ds;
    t += dt;
    if (!(std::abs(s) <= kFarthest && std::abs(t) <= kFarthest)) return std::nullopt;
    if (std::hypot(ds, dt) * scale_px <= 1e-10) {
      return PixelPoint{centre.x_px + s * scale_px, centre.y_px + t * scale_px};
    }
  }
  return std::nullopt;
}

absl::StatusOr<Registration> RegisterDisplay(std::span<const DisplayedDot> dots,
                                             std::optional<int> order) {
  EYEBOX_RETURN_IF_ERROR(Check(dots, order));
  std::optional<Fit> best;
  Registration result;
  for (int tried = order.value_or(1); tried <= order.value_or(kHighestOrder); ++tried) {
    if (!IsEnough(dots.size(), tried)) break;
    auto fit = FitOrder(dots, tried);
    if (!fit.ok()) {
      if (best) break;  // the dots determine no more than what was found
      return fit.status();
    }
    result.orders.push_back({tried, fit->left_out_rms});
    if (!best || fit->left_out_rms < best->left_out_rms) best = *std::move(fit);
  }
  const double freedom =
      2.0 * (static_cast<double>(dots.size()) - static_cast<double>(TermsOf(best->map.order)));
  result.map = std::move(best->map);
  result.residual_rms_deg = std::sqrt(best->sum_of_squares / freedom);
  result.largest_residual_deg = best->largest;
  return result;
}

}  // namespace eyebox::optics
