#include "fit/activation/level_design.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <string>

#include "absl/strings/str_cat.h"
#include "capture/base/status.h"
#include "fit/activation/activation_problem.h"

namespace eyebox::fit {
namespace {

constexpr int kIterations = 2000;
constexpr double kGoodEnough = 0.999;  // efficiency
constexpr double kSingular = 1e-14;    // of the scaled information

using Eigen::MatrixXd;
using Eigen::VectorXd;

// The design problem in the parameters that the model leaves free, each scaled so that the
// information of evenly shared time has a diagonal of 1.
struct Problem {
  MatrixXd levels;  // [candidates, free]: gradient over sigma and root of the frame's time
  MatrixXd wanted;  // [free, free]: mean of J J^T over u
};

absl::StatusOr<Problem> Pose(const ActivationFit& fit, ErrorAtU error,
                             std::span<const LevelCandidate> candidates,
                             std::span<const double> u) {
  const std::vector<int> free = FreeParameters(fit.model, fit.activation);
  const auto count = static_cast<Eigen::Index>(free.size());
  Problem problem{MatrixXd(candidates.size(), count), MatrixXd::Zero(count, count)};
  for (size_t i = 0; i < candidates.size(); ++i) {
    const LevelCandidate& one = candidates[i];
    if (!(one.frame_sigma > 0 && one.frame_time_s > 0)) {
      return BadInput(absl::StrCat("level candidate ", i + 1),
                      "its sigma or the time of its frame is not above 0", "give both");
    }
    const std::vector<double> gradient = ParameterGradient(fit.model, fit.activation, one.drive);
    for (Eigen::Index k = 0; k < count; ++k) {
      problem.levels(static_cast<Eigen::Index>(i), k) =
          gradient[free[k]] / (one.frame_sigma * std::sqrt(one.frame_time_s));
    }
  }
  for (const double x : u) {
    const std::vector<double> gradient = ErrorGradient(fit, error, x);
    VectorXd j(count);
    for (Eigen::Index k = 0; k < count; ++k) j(k) = gradient[free[k]];
    problem.wanted += j * j.transpose() / static_cast<double>(u.size());
  }
  const VectorXd lengths = problem.levels.colwise().norm();
  if (!(lengths.minCoeff() > 0)) {
    return Rejected("levels", "they do not determine the activation", "offer more drive values");
  }
  problem.levels.array().rowwise() /= lengths.transpose().array();
  problem.wanted =
      lengths.cwiseInverse().asDiagonal() * problem.wanted * lengths.cwiseInverse().asDiagonal();
  return problem;
}

absl::StatusOr<MatrixXd> Covariance(const Problem& problem, const VectorXd& shares) {
  const MatrixXd information = problem.levels.transpose() * shares.asDiagonal() * problem.levels;
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(information);
  if (!(solver.eigenvalues().minCoeff() > kSingular * solver.eigenvalues().maxCoeff())) {
    return Rejected("levels", "they do not determine the activation", "offer more drive values");
  }
  return MatrixXd(solver.eigenvectors() * solver.eigenvalues().cwiseInverse().asDiagonal() *
                  solver.eigenvectors().transpose());
}

}  // namespace

std::vector<double> ErrorGradient(const ActivationFit& fit, ErrorAtU error, double u) {
  const Activation& a = fit.activation;
  const double white = a.Luminance(1);
  // (u grad L(1) - grad L(v)) / (u L(1)) with v the table's drive; of the luminance alone without
  // the first term.
  const double drive = a.InverseH((u * white - a.minimum_luminance) / a.luminance_range);
  std::vector<double> at_white = ParameterGradient(fit.model, a, 1);
  if (error == ErrorAtU::kLuminance) std::ranges::fill(at_white, 0);
  std::vector<double> gradient = ParameterGradient(fit.model, a, drive);
  for (size_t i = 0; i < gradient.size(); ++i) {
    gradient[i] = (u * at_white[i] - gradient[i]) / (u * white);
  }
  return gradient;
}

std::vector<double> ErrorVariances(const ActivationFit& fit, ErrorAtU error,
                                   std::span<const double> u) {
  std::vector<double> variances;
  for (const double x : u) {
    const std::vector<double> gradient = ErrorGradient(fit, error, x);
    const size_t count = gradient.size();
    double variance = 0;
    for (size_t i = 0; i < count; ++i) {
      for (size_t j = 0; j < count; ++j) {
        variance += gradient[i] * fit.covariance[count * i + j] * gradient[j];
      }
    }
    variances.push_back(std::max(variance, 0.0));
  }
  return variances;
}

absl::StatusOr<LevelDesign> OptimalLevels(const ActivationFit& fit, ErrorAtU error,
                                          std::span<const LevelCandidate> candidates,
                                          std::span<const double> u) {
  EYEBOX_ASSIGN_OR_RETURN(const Problem problem, Pose(fit, error, candidates, u));
  const auto count = static_cast<Eigen::Index>(candidates.size());
  VectorXd shares = VectorXd::Constant(count, 1.0 / static_cast<double>(count));
  LevelDesign design;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    const absl::StatusOr<MatrixXd> at = Covariance(problem, shares);
    // An optimum that leaves parameters open, as one for a single u, is approached, not reached.
    if (!at.ok() && iteration > 0) break;
    EYEBOX_RETURN_IF_ERROR(at.status());
    const MatrixXd& covariance = *at;
    const MatrixXd inner = covariance * problem.wanted * covariance;
    const VectorXd gain = (problem.levels * inner).cwiseProduct(problem.levels).rowwise().sum();
    design.variance_s = (problem.wanted * covariance).trace();
    // At the optimum no candidate gains more than the mean, which is variance_s.
    design.efficiency = std::max(2 - gain.maxCoeff() / design.variance_s, 0.0);
    design.shares.assign(shares.data(), shares.data() + count);
    if (design.efficiency > kGoodEnough) break;
    shares = shares.cwiseProduct(gain.cwiseMax(0).cwiseSqrt());
    shares /= shares.sum();
  }
  return design;
}

absl::StatusOr<double> VarianceTimes(const ActivationFit& fit, ErrorAtU error,
                                     std::span<const LevelCandidate> candidates,
                                     std::span<const double> shares, std::span<const double> u) {
  EYEBOX_ASSIGN_OR_RETURN(const Problem problem, Pose(fit, error, candidates, u));
  const Eigen::Map<const VectorXd> given(shares.data(), static_cast<Eigen::Index>(shares.size()));
  EYEBOX_ASSIGN_OR_RETURN(const MatrixXd covariance, Covariance(problem, given / given.sum()));
  return (problem.wanted * covariance).trace();
}

}  // namespace eyebox::fit
