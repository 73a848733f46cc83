// One reading as Ceres sees it, with the exact derivatives of the activation.
#ifndef EYEBOX_FIT_ACTIVATION_LEVEL_RESIDUAL_H_
#define EYEBOX_FIT_ACTIVATION_LEVEL_RESIDUAL_H_

#include <array>

#include "ceres/sized_cost_function.h"
#include "fit/activation/activation_problem.h"

namespace eyebox::fit {

// Residual root_weight (L(v; L0, L1, v0, gamma) - reading), [1]; parameter blocks L0, L1, v0 and
// gamma, [1] each, so that any of them can be held.
struct LevelResidual final : ceres::SizedCostFunction<1, 1, 1, 1, 1> {
  explicit LevelResidual(const WeightedReading& weighted_reading) : reading(weighted_reading) {}

  // The caller owns it, as ceres::Problem expects.
  static ceres::CostFunction* Create(const WeightedReading& reading) {
    return new LevelResidual(reading);
  }

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    const Activation activation{*parameters[0], *parameters[1], *parameters[2], *parameters[3]};
    residuals[0] = reading.root_weight * (activation.Luminance(reading.drive) - reading.luminance);
    if (jacobians == nullptr) return true;
    const std::array<double, 4> gradient = activation.LuminanceGradient(reading.drive);
    for (int i = 0; i < 4; ++i) {
      if (jacobians[i] != nullptr) jacobians[i][0] = reading.root_weight * gradient[i];
    }
    return true;
  }

  const WeightedReading reading;
};

}  // namespace eyebox::fit

#endif  // EYEBOX_FIT_ACTIVATION_LEVEL_RESIDUAL_H_
