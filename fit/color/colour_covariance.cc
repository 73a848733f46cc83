#include <Eigen/Dense>
#include <cmath>

#include "capture/base/status.h"
#include "ceres/jet.h"
#include "fit/color/colour_forward.h"
#include "fit/color/colour_problem.h"

namespace eyebox::fit {
namespace {

// Smallest over largest singular value of the Jacobian with columns of length 1: below this the
// sigmas would be rounding errors.
constexpr double kSmallestSingular = 1e-8;
constexpr int kMostParameters = 24;
using Jet = ceres::Jet<double, kMostParameters>;

// [3 readings, parameters].
Eigen::MatrixXd WeightedJacobian(const ColourProblem& problem, const ColourModel& model) {
  const std::vector<double> values = model.ToParameters();
  const auto count = static_cast<int>(values.size());
  std::vector<Jet> parameters;
  for (int i = 0; i < count; ++i) parameters.emplace_back(values[i], i);
  Eigen::MatrixXd jacobian(3 * problem.readings.size(), count);
  Eigen::Index row = 0;
  for (const ColourReading& reading : problem.readings) {
    const std::array<Jet, 3> colour = ForwardColour(model.kind, parameters.data(), reading.drive);
    for (size_t c = 0; c < 3; ++c, ++row) {
      const double unit = std::max(reading.colour[c], problem.floor[c]);
      jacobian.row(row) = colour[c].v.head(count).transpose() / unit;
    }
  }
  return jacobian;
}

}  // namespace

absl::StatusOr<std::vector<double>> ColourCovariance(const ColourProblem& problem,
                                                     const ColourModel& model) {
  Eigen::MatrixXd jacobian = WeightedJacobian(problem, model);
  const Eigen::VectorXd lengths = jacobian.colwise().norm();
  const absl::Status undetermined =
      Rejected(problem.source,
               absl::StrCat("its stimuli do not determine the parameters of the ",
                            std::string(NameOf(model.kind)), " colour model"),
               "measure more levels, and mixtures of two channels for pairwise crosstalk");
  if (jacobian.rows() < jacobian.cols() || !lengths.allFinite() || !(lengths.minCoeff() > 0)) {
    return undetermined;
  }
  jacobian.array().rowwise() /= lengths.transpose().array();
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(jacobian, Eigen::ComputeThinV);
  const Eigen::VectorXd& singular = svd.singularValues();
  if (!(singular.minCoeff() > kSmallestSingular * singular.maxCoeff())) return undetermined;
  const Eigen::MatrixXd half =
      lengths.cwiseInverse().asDiagonal() * svd.matrixV() * singular.cwiseInverse().asDiagonal();
  const Eigen::MatrixXd inverse = half * half.transpose();
  return std::vector<double>(inverse.data(), inverse.data() + inverse.size());
}

}  // namespace eyebox::fit
