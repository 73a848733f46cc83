// Arbitrary masks and weights against Ceres on the same residuals, every k and delta a parameter of
// its own.
#include "fit/field/shared_exponent.h"

#include <ceres/ceres.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "fit/field/common_exponent.h"
#include "tests/fit/field/gradient_field.h"

namespace eyebox::fit {
namespace {

using ::testing::HasSubstr;

struct ReadingResidual {
  double drive, luminance, root_weight;

  template <typename T>
  bool operator()(const T* line, const T* shape, T* residual) const {
    using std::pow;
    const T base = (drive - shape[1]) / (1.0 - shape[1]);
    const T power = base > 0.0 ? pow(base, shape[0]) : T(0);
    residual[0] = root_weight * (line[0] * power + line[1] - luminance);
    return true;
  }
};

struct CeresFit {
  std::array<double, 2> shape;
  double cost = 0;
  std::vector<std::array<double, 2>> lines;
};

CeresFit FitWithCeres(const MaskedStack& stack, const FieldWeights& weights, bool with_cutoff) {
  const size_t locations = stack.LocationCount();
  CeresFit fit{{2, with_cutoff ? 0.02 : 0}, 0, {}};
  fit.lines.assign(locations, {100, 1});
  ceres::Problem problem;
  for (size_t i = 0; i < stack.luminance.size(); ++i) {
    if (stack.valid[i] == 0) continue;
    const double root = std::sqrt(weights.levels[i / locations] * weights.locations[i % locations]);
    problem.AddResidualBlock(
        new ceres::AutoDiffCostFunction<ReadingResidual, 1, 2, 2>(
            new ReadingResidual{stack.drives[i / locations], stack.luminance[i], root}),
        nullptr, fit.lines[i % locations].data(), fit.shape.data());
  }
  if (!with_cutoff) {
    problem.SetManifold(fit.shape.data(), new ceres::SubsetManifold(2, {1}));
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_SCHUR;
  options.logging_type = ceres::SILENT;
  options.max_num_iterations = 100;
  options.function_tolerance = 1e-18;
  options.gradient_tolerance = 1e-18;
  options.parameter_tolerance = 1e-14;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  EXPECT_EQ(summary.termination_type, ceres::CONVERGENCE) << summary.BriefReport();
  fit.cost = summary.final_cost;
  return fit;
}

void ExpectAgreement(const GradientField& field, bool with_cutoff) {
  const auto weights = RelativeFieldWeights(field.Stack());
  ASSERT_TRUE(weights.ok()) << weights.status();
  SharedExponentOptions options;
  options.with_cutoff = with_cutoff;
  const auto fit = FitSharedExponent(field.Stack(), *weights, options);
  ASSERT_TRUE(fit.ok()) << fit.status();
  const CeresFit ceres = FitWithCeres(field.Stack(), *weights, with_cutoff);
  EXPECT_NEAR(fit->gamma / ceres.shape[0], 1, 1e-8);
  EXPECT_NEAR(fit->cutoff_drive, ceres.shape[1], 1e-8);
  EXPECT_NEAR(fit->weighted_sum_of_squares / (2 * ceres.cost), 1, 1e-8);
  double worst = 0;
  for (size_t i = 0; i < field.regions.size(); ++i) {
    if (std::isnan(fit->gain[i])) continue;
    worst = std::max(worst, std::abs(fit->gain[i] / ceres.lines[i][0] - 1));
    worst = std::max(worst, std::abs(fit->offset[i] / ceres.lines[i][1] - 1));
  }
  EXPECT_LT(worst, 1e-6);
  std::printf("%zu locations, %zu masks: gamma %.1e, k and delta %.1e from Ceres (relative)\n",
              fit->locations, fit->distinct_masks, std::abs(fit->gamma / ceres.shape[0] - 1),
              worst);
}

// Nearly as many masks as locations.
TEST(SharedExponentTest, TenThousandLocationsWithRandomMasksAgreeWithCeres) {
  ExpectAgreement(
      SimulateGradient({.locations = 10000, .levels = 17, .masked_share = 0.3, .seed = 3}), false);
}

TEST(SharedExponentTest, GammaAndCutoffAgreeWithCeres) {
  ExpectAgreement(
      SimulateGradient(
          {.locations = 400, .levels = 17, .masked_share = 0.2, .cutoff = 0.04, .seed = 4}),
      true);
}

TEST(SharedExponentTest, FewMasksAreReducedWithoutALoss) {
  GradientField field = SimulateGradient({.locations = 3000, .levels = 17, .seed = 5});
  for (size_t i = 0; i < field.valid.size(); ++i) {
    field.valid[i] = i % 3000 < 1000 || i / 3000 > 4 ? 1 : 0;
  }
  ExpectAgreement(field, false);
}

TEST(SharedExponentTest, WithoutMasksItIsTheCommonExponent) {
  const GradientField field = SimulateGradient({.locations = 500, .levels = 17, .seed = 6});
  CommonExponentOptions options;
  options.level_weights = std::vector<double>(17, 0.01);
  const auto fast = FitCommonExponent({field.drives, field.luminance, {}}, options);
  const auto fit = FitSharedExponent({field.drives, field.luminance, {}},
                                     {options.level_weights, std::vector<double>(500, 1)});
  ASSERT_TRUE(fast.ok() && fit.ok()) << fast.status() << fit.status();
  EXPECT_NEAR(fit->gamma, fast->gamma, 1e-9);
  EXPECT_NEAR(fit->gamma_sigma / fast->gamma_sigma, 1, 0.01);
  EXPECT_NEAR(fit->degrees_of_freedom, fast->degrees_of_freedom, 0);
  EXPECT_NEAR(fit->gain[77], fast->gain[77], 1e-4);
}

TEST(SharedExponentTest, SigmasCoverTheTruth) {
  double gamma_squares = 0;
  double cutoff_squares = 0;
  constexpr int kFields = 200;
  SharedExponentOptions options;
  options.with_cutoff = true;
  for (uint64_t seed = 0; seed < kFields; ++seed) {
    const GradientField field =
        SimulateGradient({.masked_share = 0.1, .cutoff = 0.05, .seed = 100 + seed});
    const auto weights = RelativeFieldWeights(field.Stack());
    const auto fit = FitSharedExponent(field.Stack(), *weights, options);
    ASSERT_TRUE(fit.ok()) << fit.status();
    gamma_squares += std::pow((fit->gamma - 2.2) / fit->gamma_sigma, 2) / kFields;
    cutoff_squares += std::pow((fit->cutoff_drive - 0.05) / fit->cutoff_sigma, 2) / kFields;
  }
  EXPECT_NEAR(std::sqrt(gamma_squares), 1, 0.15);
  EXPECT_NEAR(std::sqrt(cutoff_squares), 1, 0.15);
}

TEST(SharedExponentTest, LocationsThatCannotTakePartAreNaN) {
  GradientField field = SimulateGradient({.locations = 20, .levels = 9, .seed = 8});
  const auto weights = RelativeFieldWeights(field.Stack());
  for (size_t level = 2; level < 9; ++level) {
    field.valid[level * 20 + 7] = 0;
    field.luminance[level * 20 + 7] = std::numeric_limits<float>::quiet_NaN();
  }
  const auto fit = FitSharedExponent(field.Stack(), *weights);
  ASSERT_TRUE(fit.ok()) << fit.status();
  EXPECT_EQ(fit->locations, 19U);
  EXPECT_TRUE(std::isnan(fit->gain[7]) && std::isnan(fit->offset[7]) && std::isnan(fit->rms[7]));
  EXPECT_FALSE(std::isnan(fit->gain[6]));
}

TEST(SharedExponentTest, BadInputIsNamed) {
  GradientField field = SimulateGradient({.locations = 20, .levels = 9, .seed = 9});
  const auto weights = RelativeFieldWeights(field.Stack());
  FieldWeights wrong = *weights;
  wrong.levels[3] = 0;
  EXPECT_TRUE(absl::IsInvalidArgument(FitSharedExponent(field.Stack(), wrong).status()));
  wrong = *weights;
  wrong.locations.pop_back();
  EXPECT_TRUE(absl::IsInvalidArgument(FitSharedExponent(field.Stack(), wrong).status()));
  field.luminance[4 * 20 + 5] = std::numeric_limits<float>::infinity();
  const auto fit = FitSharedExponent(field.Stack(), *weights);
  EXPECT_THAT(std::string(fit.status().message()), HasSubstr("level 5, location 5"));
  field.valid.assign(field.valid.size(), 0);
  EXPECT_TRUE(absl::IsFailedPrecondition(FitSharedExponent(field.Stack(), *weights).status()));
}

}  // namespace
}  // namespace eyebox::fit
