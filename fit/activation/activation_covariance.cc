#include <Eigen/Dense>
#include <cmath>

#include "capture/base/status.h"
#include "fit/activation/activation_problem.h"

namespace eyebox::fit {
namespace {

// Smallest over largest singular value of the Jacobian with columns of length 1: below this the
// sigmas would be rounding errors.
constexpr double kSmallestSingular = 1e-9;

// [readings, free parameters], in the order L0, L1, (v0,) gamma.
Eigen::MatrixXd WeightedJacobian(const ActivationProblem& problem, const Activation& activation,
                                 const std::vector<int>& free) {
  Eigen::MatrixXd jacobian(problem.readings.size(), free.size());
  for (Eigen::Index row = 0; row < jacobian.rows(); ++row) {
    const WeightedReading& reading = problem.readings[row];
    const std::array<double, 4> gradient = activation.LuminanceGradient(reading.drive);
    for (Eigen::Index k = 0; k < jacobian.cols(); ++k) {
      jacobian(row, k) = reading.root_weight * gradient[free[k]];
    }
  }
  return jacobian;
}

}  // namespace

absl::StatusOr<std::array<double, 16>> ActivationCovariance(const ActivationProblem& problem,
                                                            const Activation& activation) {
  std::vector<int> free = {0, 1, 2, 3};
  if (problem.model == ActivationModel::kPowerOffset) free = {0, 1, 3};
  Eigen::MatrixXd jacobian = WeightedJacobian(problem, activation, free);
  const Eigen::VectorXd lengths = jacobian.colwise().norm();
  const absl::Status undetermined =
      Rejected(NameOf(problem.model), "the readings do not determine its parameters",
               "measure more levels, above all where the luminance begins to rise");
  if (!(lengths.minCoeff() > 0) || !lengths.allFinite()) return undetermined;
  jacobian.array().rowwise() /= lengths.transpose().array();
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(jacobian, Eigen::ComputeThinV);
  const Eigen::VectorXd& singular = svd.singularValues();
  if (!(singular.minCoeff() > kSmallestSingular * singular.maxCoeff())) return undetermined;
  const Eigen::MatrixXd half =
      lengths.cwiseInverse().asDiagonal() * svd.matrixV() * singular.cwiseInverse().asDiagonal();
  const Eigen::MatrixXd inverse = half * half.transpose();
  std::array<double, 16> covariance{};
  for (Eigen::Index i = 0; i < inverse.rows(); ++i) {
    for (Eigen::Index j = 0; j < inverse.cols(); ++j) {
      covariance[4 * free[i] + free[j]] = inverse(i, j);
    }
  }
  return covariance;
}

}  // namespace eyebox::fit
