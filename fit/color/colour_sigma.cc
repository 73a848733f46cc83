#include "fit/color/colour_sigma.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <vector>

#include "ceres/jet.h"
#include "fit/color/colour_forward.h"

namespace eyebox::fit {
namespace {

constexpr int kMostParameters = 24;
using Jet = ceres::Jet<double, kMostParameters>;
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

}  // namespace

Xyz ColourSigma(const ColourModel& model, std::span<const double> covariance, const Rgb& drive) {
  const std::vector<double> values = model.ToParameters();
  const auto count = static_cast<Eigen::Index>(values.size());
  std::vector<Jet> parameters;
  for (Eigen::Index i = 0; i < count; ++i) {
    parameters.emplace_back(values[static_cast<size_t>(i)], static_cast<int>(i));
  }
  const Eigen::Map<const RowMajor> matrix(covariance.data(), count, count);
  const std::array<Jet, 3> colour = ForwardColour(model.kind, parameters.data(), drive);
  Xyz sigma = {};
  for (size_t c = 0; c < 3; ++c) {
    const Eigen::VectorXd slope = colour[c].v.head(count);
    // Rounding may leave a variance of 0 a little below it.
    sigma[c] = std::sqrt(std::max(slope.dot(matrix * slope), 0.0));
  }
  return sigma;
}

}  // namespace eyebox::fit
