#include "optics/uniformity/order_weights.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "opencv2/core.hpp"
#include "opencv2/core/optim.hpp"

namespace eyebox::optics {
namespace {

constexpr double kKinkPower = 4;
constexpr double kSteepestDecay = 20;     // from order to order, in logarithms
constexpr double kLargestLogarithm = 80;  // of a variance over that of all coefficients together
constexpr double kLeastVariance = 1e-30;  // likewise
// Where the search for the most likely starts: decay, and the kink over the noise.
constexpr double kFirstDecays[] = {1.5, 3.5};
constexpr double kFirstKinks[] = {0, 6};
constexpr int kMostSteps = 600;
constexpr double kSettled = 0.01;  // of the log likelihood: what that changes is far below a sigma

// Coefficients without the mean, of functions with a root mean square of 1.
struct Measured {
  Eigen::VectorXd value;
  Eigen::MatrixXd covariance;
  std::vector<int> order;
  std::vector<double> size;  // of the basis function, relative to that of root mean square 1
  double scale = 1;          // variance of all together
  double noise = 1;          // factor on the stated variances of the pixels, at least 1
};

Measured Measure(const NormalEquations& equations, const FieldBasis& basis) {
  const auto& terms = basis.Terms();
  const auto n = static_cast<Eigen::Index>(terms.size());
  const Eigen::Map<const Eigen::MatrixXd> matrix(equations.matrix.data(), n, n);
  const Eigen::LDLT<Eigen::MatrixXd> factors(matrix);
  const Eigen::VectorXd solution =
      factors.solve(Eigen::Map<const Eigen::VectorXd>(equations.right_side.data(), n));
  const double chi2 = equations.Chi2({solution.data(), terms.size()});
  const double freedom =
      std::max(static_cast<double>(equations.pixels) - static_cast<double>(n), 1.0);
  Measured measured;
  measured.noise = std::max(chi2 / freedom, 1.0);
  Eigen::VectorXd to_unit(n - 1);
  for (Eigen::Index i = 0; i + 1 < n; ++i) {
    const auto [a, b] = terms[i + 1];
    measured.order.push_back(a + b);
    measured.size.push_back(1 / std::sqrt((2.0 * a + 1) * (2.0 * b + 1)));
    to_unit(i) = measured.size.back();
  }
  measured.value = solution.tail(n - 1).cwiseProduct(to_unit);
  const Eigen::MatrixXd covariance = factors.solve(Eigen::MatrixXd::Identity(n, n));
  measured.covariance = measured.noise * to_unit.asDiagonal() *
                        covariance.bottomRightCorner(n - 1, n - 1) * to_unit.asDiagonal();
  measured.scale = measured.value.squaredNorm() + measured.covariance.trace();
  return measured;
}

// x: logarithms of A and B over the scale, decay b in between.
double VarianceOf(const double* x, int order, double scale) {
  const double smooth = std::exp(x[0] - x[1] * (order - 1));
  const double kink = std::exp(x[2]) * std::pow(order, -kKinkPower);
  return scale * std::max(smooth + kink, kLeastVariance);
}

class MinusLogLikelihood final : public cv::MinProblemSolver::Function {
 public:
  explicit MinusLogLikelihood(const Measured& measured) : measured_(measured) {}

  int getDims() const override { return 3; }

  double calc(const double* x) const override {
    const bool within = std::abs(x[0]) <= kLargestLogarithm && x[1] >= 0 &&
                        x[1] <= kSteepestDecay && std::abs(x[2]) <= kLargestLogarithm;
    if (!within) return std::numeric_limits<double>::max();
    Eigen::MatrixXd covariance = measured_.covariance;
    for (Eigen::Index i = 0; i < covariance.rows(); ++i) {
      covariance(i, i) += VarianceOf(x, measured_.order[i], measured_.scale);
    }
    const Eigen::LLT<Eigen::MatrixXd> factors(covariance);
    if (factors.info() != Eigen::Success) return std::numeric_limits<double>::max();
    const Eigen::VectorXd whitened = factors.matrixL().solve(measured_.value);
    return 0.5 * whitened.squaredNorm() +
           Eigen::MatrixXd(factors.matrixL()).diagonal().array().log().sum();
  }

 private:
  const Measured& measured_;
};

cv::Mat1d MostLikely(const Measured& measured) {
  const auto solver = cv::DownhillSolver::create(
      cv::makePtr<MinusLogLikelihood>(measured), cv::Mat1d(1, 3, 1.0),
      cv::TermCriteria(cv::TermCriteria::MAX_ITER + cv::TermCriteria::EPS, kMostSteps, kSettled));
  const double noise =
      measured.covariance.trace() / (static_cast<double>(measured.value.size()) * measured.scale);
  cv::Mat1d best;
  double least = std::numeric_limits<double>::infinity();
  for (const double decay : kFirstDecays) {
    for (const double kink : kFirstKinks) {
      cv::Mat1d x = (cv::Mat1d(1, 3) << 0.0, decay, std::log(noise) + kink);
      const double found = solver->minimize(x);
      if (!best.empty() && !(found < least)) continue;
      least = found;
      best = x.clone();
    }
  }
  return best;
}

}  // namespace

std::vector<double> OrderPenalties(const NormalEquations& equations, const FieldBasis& basis) {
  const Measured measured = Measure(equations, basis);
  const cv::Mat1d x = MostLikely(measured);
  std::vector<double> penalties = {0};
  for (size_t i = 0; i < measured.order.size(); ++i) {
    const double variance = VarianceOf(x[0], measured.order[i], measured.scale);
    penalties.push_back(measured.noise * measured.size[i] * measured.size[i] / variance);
  }
  return penalties;
}

}  // namespace eyebox::optics
