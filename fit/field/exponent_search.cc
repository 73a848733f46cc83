#include "fit/field/exponent_search.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "fit/base/activation.h"

namespace eyebox::fit {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kScanSteps = 64;           // valleys are much wider than a step of 5 %
constexpr int kMostHalvings = 100;       // doubles end after about 55
constexpr double kCurvatureStep = 1e-4;  // of gamma

VectorXd ToVector(std::span<const double> values) {
  return Eigen::Map<const VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

// The weighted sum of squares of L_i(v) = k_i v^gamma + delta_i over all locations as a function of
// gamma, with the best k and delta at each. Let a be the part of sqrt(w) v^gamma orthogonal to
// sqrt(w), scaled to length 1, and C the products of that part of the weighted data: it is
// tr C - a^T C a.
class Profile {
 public:
  explicit Profile(const ExponentProblem& problem)
      : drives_(ToVector(problem.drives)),
        root_weights_(ToVector(problem.weights).cwiseSqrt()),
        constant_(root_weights_.normalized()) {
    const Eigen::Index levels = drives_.size();
    scatter_ = root_weights_.asDiagonal() *
               Eigen::Map<const MatrixXd>(problem.products.data(), levels, levels) *
               root_weights_.asDiagonal();
    const VectorXd along = scatter_ * constant_;
    scatter_ += constant_.dot(along) * constant_ * constant_.transpose() -
                constant_ * along.transpose() - along * constant_.transpose();
  }

  double SumOfSquares(double gamma) const {
    const VectorXd unit = CentredGradient(gamma, 1).normalized();
    return scatter_.trace() - unit.dot(scatter_ * unit);
  }

  double Slope(double gamma) const {
    const VectorXd power = CentredGradient(gamma, 1);
    const VectorXd unit = power.normalized();
    const VectorXd by_gamma = CentredGradient(gamma, 3);
    const VectorXd unit_by_gamma = (by_gamma - unit * unit.dot(by_gamma)) / power.norm();
    return -2 * unit_by_gamma.dot(scatter_ * unit);
  }

  double Curvature(double gamma) const {
    const double step = kCurvatureStep * gamma;
    return (Slope(gamma + step) - Slope(gamma - step)) / (2 * step);
  }

 private:
  // sqrt(w) dL/d(parameter), orthogonal to sqrt(w): parameter 1 gives v^gamma, 3 v^gamma ln v.
  VectorXd CentredGradient(double gamma, int parameter) const {
    const Activation activation{0, 1, 0, gamma};
    const VectorXd weighted = root_weights_.binaryExpr(drives_, [&](double root_weight, double v) {
      return root_weight * activation.LuminanceGradient(v)[parameter];
    });
    return weighted - constant_ * constant_.dot(weighted);
  }

  VectorXd drives_;
  VectorXd root_weights_;
  VectorXd constant_;
  MatrixXd scatter_;
};

}  // namespace

ExponentOptimum FindExponent(const ExponentProblem& problem) {
  const Profile profile(problem);
  const auto gamma_at = [&](int step) {
    const double share = static_cast<double>(std::clamp(step, 0, kScanSteps)) / kScanSteps;
    return problem.gamma_min * std::pow(problem.gamma_max / problem.gamma_min, share);
  };
  int lowest = 0;
  double least = profile.SumOfSquares(gamma_at(0));
  for (int step = 1; step <= kScanSteps; ++step) {
    const double sum = profile.SumOfSquares(gamma_at(step));
    if (sum >= least) continue;
    least = sum;
    lowest = step;
  }
  double low = gamma_at(lowest - 1);
  double high = gamma_at(lowest + 1);
  ExponentOptimum optimum{gamma_at(lowest), true, least, 0, kScanSteps + 1};
  if (!(profile.Slope(low) < 0 && profile.Slope(high) > 0)) return optimum;
  for (int i = 0; i < kMostHalvings; ++i) {
    const double middle = 0.5 * (low + high);
    if (middle <= low || middle >= high) break;
    (profile.Slope(middle) < 0 ? low : high) = middle;
    ++optimum.evaluations;
  }
  optimum.at_limit = false;
  optimum.gamma = 0.5 * (low + high);
  optimum.sum_of_squares = std::max(profile.SumOfSquares(optimum.gamma), 0.0);
  optimum.curvature = profile.Curvature(optimum.gamma);
  return optimum;
}

}  // namespace eyebox::fit
