#include <Eigen/Dense>
#include <cmath>

#include "capture/base/status.h"
#include "fit/activation/activation_problem.h"

namespace eyebox::fit {
namespace {

// Smallest over largest singular value of the Jacobian with columns of length 1: below this the
// sigmas would be rounding errors.
constexpr double kSmallestSingular = 1e-9;
constexpr int kCutoff = 2;
constexpr int kGamma = 3;

// [readings, parameters], of the weighted readings.
Eigen::MatrixXd WeightedJacobian(const ActivationProblem& problem, ActivationModel model,
                                 const Activation& activation, const std::vector<int>& columns) {
  Eigen::MatrixXd jacobian(problem.readings.size(), columns.size());
  for (Eigen::Index row = 0; row < jacobian.rows(); ++row) {
    const WeightedReading& reading = problem.readings[row];
    const std::vector<double> gradient = ParameterGradient(model, activation, reading.drive);
    for (Eigen::Index k = 0; k < jacobian.cols(); ++k) {
      jacobian(row, k) = reading.root_weight * gradient[columns[k]];
    }
  }
  return jacobian;
}

// How the parameters follow the weighted readings, [parameters, readings].
absl::StatusOr<Eigen::MatrixXd> PseudoInverse(Eigen::MatrixXd jacobian, ActivationModel model) {
  const Eigen::VectorXd lengths = jacobian.colwise().norm();
  const absl::Status undetermined =
      Rejected(NameOf(model), "the readings do not determine its parameters",
               "measure more levels, above all where the luminance begins to rise");
  if (!(lengths.minCoeff() > 0) || !lengths.allFinite()) return undetermined;
  jacobian.array().rowwise() /= lengths.transpose().array();
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(jacobian, Eigen::ComputeThinU | Eigen::ComputeThinV);
  const Eigen::VectorXd& singular = svd.singularValues();
  if (!(singular.minCoeff() > kSmallestSingular * singular.maxCoeff())) return undetermined;
  return Eigen::MatrixXd(lengths.cwiseInverse().asDiagonal() * svd.matrixV() *
                         singular.cwiseInverse().asDiagonal() * svd.matrixU().transpose());
}

// The second stage sees the readings less what the first one's v0 and gamma make of them.
absl::StatusOr<Eigen::MatrixXd> SplineResponse(const ActivationProblem& problem,
                                               const ActivationSolution& solution,
                                               const std::vector<int>& free) {
  EYEBOX_ASSIGN_OR_RETURN(
      const Eigen::MatrixXd first,
      PseudoInverse(WeightedJacobian(problem, ActivationModel::kGammaWithCutoff, solution.gamma_fit,
                                     {0, 1, kCutoff, kGamma}),
                    problem.model));
  std::vector<int> second_stage;
  for (const int parameter : free) {
    if (parameter != kCutoff && parameter != kGamma) second_stage.push_back(parameter);
  }
  const auto jacobian = [&](const std::vector<int>& columns) {
    return WeightedJacobian(problem, problem.model, solution.activation, columns);
  };
  EYEBOX_ASSIGN_OR_RETURN(const Eigen::MatrixXd second,
                          PseudoInverse(jacobian(second_stage), problem.model));
  const auto readings = static_cast<Eigen::Index>(problem.readings.size());
  const Eigen::MatrixXd held = first.middleRows(kCutoff, 2);
  const Eigen::MatrixXd fitted =
      second * (Eigen::MatrixXd::Identity(readings, readings) - jacobian({kCutoff, kGamma}) * held);
  Eigen::MatrixXd response(fitted.rows() + 2, readings);
  response << fitted.topRows(2), held, fitted.bottomRows(fitted.rows() - 2);
  return response;
}

// [free parameters, readings], of the weighted readings.
absl::StatusOr<Eigen::MatrixXd> FreeResponse(const ActivationProblem& problem,
                                             const ActivationSolution& solution,
                                             const std::vector<int>& free) {
  if (problem.model == ActivationModel::kMonotoneSpline) {
    return SplineResponse(problem, solution, free);
  }
  return PseudoInverse(WeightedJacobian(problem, problem.model, solution.activation, free),
                       problem.model);
}

}  // namespace

absl::StatusOr<std::vector<double>> ActivationCovariance(const ActivationProblem& problem,
                                                         const ActivationSolution& solution) {
  const std::vector<int> free = FreeParameters(problem.model, solution.activation);
  EYEBOX_ASSIGN_OR_RETURN(const Eigen::MatrixXd response, FreeResponse(problem, solution, free));
  const Eigen::MatrixXd among_free = response * response.transpose();
  const size_t count = static_cast<size_t>(free.back()) + 1;
  std::vector<double> covariance(count * count, 0.0);
  for (Eigen::Index i = 0; i < among_free.rows(); ++i) {
    for (Eigen::Index j = 0; j < among_free.cols(); ++j) {
      covariance[count * free[i] + free[j]] = among_free(i, j);
    }
  }
  return covariance;
}

absl::StatusOr<std::vector<double>> ActivationResponse(const ActivationProblem& problem,
                                                       const ActivationSolution& solution) {
  const std::vector<int> free = FreeParameters(problem.model, solution.activation);
  EYEBOX_ASSIGN_OR_RETURN(const Eigen::MatrixXd weighted, FreeResponse(problem, solution, free));
  const size_t readings = problem.readings.size();
  std::vector<double> response((static_cast<size_t>(free.back()) + 1) * readings, 0.0);
  for (Eigen::Index i = 0; i < weighted.rows(); ++i) {
    for (size_t j = 0; j < readings; ++j) {
      response[readings * free[i] + j] =
          problem.readings[j].root_weight * weighted(i, static_cast<Eigen::Index>(j));
    }
  }
  return response;
}

}  // namespace eyebox::fit
