#include "tests/tools/numerics/single_precision.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "fit/base/activation.h"
#include "fit/base/conditioning.h"
#include "fit/field/common_exponent.h"
#include "fit/field/exponent_search.h"
#include "tests/tools/numerics/digits.h"

namespace eyebox::numerics {
namespace {

struct Field {
  double gamma = 0;
  std::vector<double> drives;
  std::vector<double> gain, offset;  // [locations]
  std::vector<double> luminance;     // [levels, locations], to the last digit
};

// Gains fall to a third over the field, as vignetting makes them.
Field MakeField(double gamma, double black, double white_cd_m2, int levels) {
  Field field;
  field.gamma = gamma;
  for (size_t i = 0; i < kFieldLocations; ++i) {
    const double share = 1 - 2.0 / 3 * static_cast<double>(i) / (kFieldLocations - 1);
    field.gain.push_back(white_cd_m2 / (1 + black) * share);
    field.offset.push_back(black * field.gain.back());
  }
  for (int level = 0; level < levels; ++level) {
    field.drives.push_back(level / (levels - 1.0));
    const Digits50 power = pow(Digits50(field.drives.back()), Digits50(gamma));
    for (size_t i = 0; i < kFieldLocations; ++i) {
      field.luminance.push_back(static_cast<double>(field.gain[i] * power + field.offset[i]));
    }
  }
  return field;
}

double GammaInDoubles(const Field& field) {
  const auto levels = static_cast<Eigen::Index>(field.drives.size());
  const Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>
      stack(field.luminance.data(), levels, kFieldLocations);
  const Eigen::MatrixXd products = stack * stack.transpose();
  const Eigen::VectorXd means = stack.rowwise().mean();
  std::vector<double> weights;
  for (Eigen::Index level = 0; level < levels; ++level) {
    weights.push_back(std::pow(std::max(means[level], 1e-3 * means.maxCoeff()), -2.0));
  }
  return fit::FindExponent({field.drives,
                            weights,
                            {products.data(), static_cast<size_t>(products.size())},
                            0.2,
                            10})
      .gamma;
}

// Of the weighted regression on gain, offset and gamma of one location.
double Condition(const Field& field) {
  const auto levels = static_cast<Eigen::Index>(field.drives.size());
  Eigen::MatrixXd jacobian(levels, 3);
  const fit::Activation activation{field.offset[0], field.gain[0], 0, field.gamma};
  for (Eigen::Index level = 0; level < levels; ++level) {
    const auto gradient = activation.LuminanceGradient(field.drives[level]);
    const double white = field.gain[0] + field.offset[0];
    const double weight = 1 / std::max(activation.Luminance(field.drives[level]), 1e-3 * white);
    jacobian.row(level) = weight * Eigen::RowVector3d(gradient[1], gradient[0], gradient[3]);
  }
  const Eigen::Matrix3d covariance = (jacobian.transpose() * jacobian).inverse();
  return fit::ConditionNumber({covariance.data(), 9});
}

PrecisionLoss Measure(const Field& field) {
  PrecisionLoss loss;
  loss.gamma_float64 = std::abs(GammaInDoubles(field) / field.gamma - 1);
  loss.condition = Condition(field);
  const std::vector<float> single(field.luminance.begin(), field.luminance.end());
  fit::CommonExponentOptions options;
  options.gamma_min = 0.2;
  options.gamma_max = 10;
  const auto found = fit::FitCommonExponent({field.drives, single, {}}, options);
  if (!found.ok()) {
    loss.gamma_float32 = loss.gain_float32 = loss.luminance_float32 =
        std::numeric_limits<double>::infinity();
    return loss;
  }
  loss.gamma_float32 = std::abs(found->gamma / field.gamma - 1);
  for (size_t i = 0; i < kFieldLocations; ++i) {
    loss.gain_float32 = std::max(loss.gain_float32, std::abs(found->gain[i] / field.gain[i] - 1));
    const fit::Activation fitted{found->offset[i], found->gain[i], 0, found->gamma};
    for (size_t level = 0; level < field.drives.size(); ++level) {
      const double truth = field.luminance[level * kFieldLocations + i];
      const double floor = 1e-3 * (field.gain[i] + field.offset[i]);
      const double error = std::abs(fitted.Luminance(field.drives[level]) - truth);
      loss.luminance_float32 = std::max(loss.luminance_float32, error / std::max(truth, floor));
    }
  }
  return loss;
}

}  // namespace

std::vector<PrecisionLoss> MeasurePrecisionLoss(bool dense) {
  const std::vector<double> gammas =
      dense ? std::vector<double>{0.3, 1, 1.8, 2.2, 2.6, 4, 8} : std::vector<double>{0.3, 2.2, 8};
  std::vector<PrecisionLoss> losses;
  for (const double gamma : gammas) {
    for (const double black : {0.0, 1e-3, 0.1}) {
      for (const double white_cd_m2 : {1e-4, 1e5}) {
        for (const int levels : {5, 17, 65}) {
          const Field field = MakeField(gamma, black, white_cd_m2, levels);
          PrecisionLoss loss = Measure(field);
          loss.gamma = gamma;
          loss.black = black;
          loss.white_cd_m2 = white_cd_m2;
          loss.levels = levels;
          losses.push_back(loss);
        }
      }
    }
  }
  return losses;
}

}  // namespace eyebox::numerics
