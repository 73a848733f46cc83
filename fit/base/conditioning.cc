#include "fit/base/conditioning.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>
#include <vector>

namespace eyebox::fit {

double ConditionNumber(std::span<const double> covariance) {
  const auto count =
      static_cast<size_t>(std::lround(std::sqrt(static_cast<double>(covariance.size()))));
  std::vector<size_t> free;
  for (size_t i = 0; i < count; ++i) {
    if (covariance[(count + 1) * i] > 0) free.push_back(i);
  }
  if (free.size() < 2) return 1;
  const auto order = static_cast<Eigen::Index>(free.size());
  Eigen::MatrixXd correlation(order, order);
  for (Eigen::Index i = 0; i < order; ++i) {
    for (Eigen::Index j = 0; j < order; ++j) {
      // One by one: the product of two small variances may leave the range of doubles.
      const double sigma_i = std::sqrt(covariance[(count + 1) * free[i]]);
      const double sigma_j = std::sqrt(covariance[(count + 1) * free[j]]);
      correlation(i, j) = covariance[count * free[i] + free[j]] / sigma_i / sigma_j;
    }
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(correlation, Eigen::EigenvaluesOnly);
  const double least = solver.eigenvalues().minCoeff();
  const double most = solver.eigenvalues().maxCoeff();
  const double rounding =
      static_cast<double>(order) * std::numeric_limits<double>::epsilon() * most;
  return least > rounding ? most / least : std::numeric_limits<double>::infinity();
}

}  // namespace eyebox::fit
