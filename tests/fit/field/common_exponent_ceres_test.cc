// The closed form against Ceres on the same residuals, every k and delta a parameter of its own.
#include <ceres/ceres.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "fit/field/common_exponent.h"
#include "tests/fit/field/simulated_field.h"

namespace eyebox::fit {
namespace {

struct LocationResidual {
  double drive, luminance, root_weight;

  static ceres::CostFunction* Create(const LocationResidual& residual) {
    return new ceres::AutoDiffCostFunction<LocationResidual, 1, 2, 1>(
        new LocationResidual(residual));
  }

  template <typename T>
  bool operator()(const T* line, const T* gamma, T* residual) const {
    using std::pow;
    const T power = drive > 0 ? pow(T(drive), gamma[0]) : T(0);
    residual[0] = root_weight * (line[0] * power + line[1] - luminance);
    return true;
  }
};

struct CeresFit {
  double gamma = 2;
  double cost = 0;
  std::vector<std::array<double, 2>> lines;
};

CeresFit FitWithCeres(const SimulatedField& field, const std::vector<double>& weights) {
  const size_t locations = field.gains.size();
  CeresFit fit;
  fit.lines.assign(locations, {100, 1});
  ceres::Problem problem;
  for (size_t i = 0; i < field.luminance.size(); ++i) {
    const size_t location = i % locations;
    if (!field.valid.empty() && field.valid[location] == 0) continue;
    problem.AddResidualBlock(
        LocationResidual::Create(
            {field.drives[i / locations], field.luminance[i], std::sqrt(weights[i / locations])}),
        nullptr, fit.lines[location].data(), &fit.gamma);
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_SCHUR;
  options.logging_type = ceres::SILENT;
  options.max_num_iterations = 200;
  options.function_tolerance = 1e-18;
  options.gradient_tolerance = 1e-18;
  options.parameter_tolerance = 1e-14;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  EXPECT_EQ(summary.termination_type, ceres::CONVERGENCE) << summary.BriefReport();
  fit.cost = summary.final_cost;
  return fit;
}

void ExpectAgreement(const SimulatedField& field, const std::vector<double>& weights) {
  CommonExponentOptions options;
  options.level_weights = weights;
  const auto fit = FitCommonExponent(field.Stack(), options);
  ASSERT_TRUE(fit.ok()) << fit.status();
  const CeresFit ceres = FitWithCeres(field, weights);
  EXPECT_NEAR(fit->gamma / ceres.gamma, 1, 1e-8);
  EXPECT_NEAR(fit->weighted_sum_of_squares / (2 * ceres.cost), 1, 1e-6);
  for (size_t i = 0; i < field.gains.size(); ++i) {
    if (!field.valid.empty() && field.valid[i] == 0) continue;
    ASSERT_NEAR(fit->gain[i] / ceres.lines[i][0], 1, 1e-6) << "location " << i;
    ASSERT_NEAR(fit->offset[i] / ceres.lines[i][1], 1, 1e-6) << "location " << i;
  }
}

TEST(CommonExponentCeresTest, RelativeWeightsAgree) {
  const SimulatedField field = SimulateField({500, 17, 2.2, 0.01, 1, 5});
  std::vector<double> weights;
  for (const double drive : field.drives) {
    weights.push_back(std::pow(100 * std::pow(drive, 2.2) + 0.6, -2));
  }
  ExpectAgreement(field, weights);
}

TEST(CommonExponentCeresTest, EqualWeightsAgree) {
  ExpectAgreement(SimulateField({500, 17, 1.8, 0.02, 1, 6}), std::vector<double>(17, 1));
}

TEST(CommonExponentCeresTest, RandomMasksAgree) {
  SimulatedField field = SimulateField({10000, 17, 2.6, 0.01, 1, 7});
  RandomStream random({8});
  for (size_t i = 0; i < 10000; ++i) field.valid.push_back(random.Uniform() < 0.7 ? 1 : 0);
  for (size_t i = 0; i < field.luminance.size(); ++i) {
    if (field.valid[i % 10000] == 0) field.luminance[i] = std::nanf("");
  }
  ExpectAgreement(field, std::vector<double>(17, 0.01));
}

TEST(CommonExponentCeresTest, DataWithoutNoiseAgree) {
  const SimulatedField field = SimulateField({300, 17, 2.2, 0, 1, 9});
  std::vector<double> weights(17, 1e-4);
  CommonExponentOptions options;
  options.level_weights = weights;
  const auto fit = FitCommonExponent(field.Stack(), options);
  ASSERT_TRUE(fit.ok()) << fit.status();
  EXPECT_NEAR(fit->gamma / FitWithCeres(field, weights).gamma, 1, 1e-9);
}

}  // namespace
}  // namespace eyebox::fit
