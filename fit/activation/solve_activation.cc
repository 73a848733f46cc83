#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "capture/base/status.h"
#include "ceres/problem.h"
#include "ceres/sized_cost_function.h"
#include "ceres/solver.h"
#include "fit/activation/activation_problem.h"

namespace eyebox::fit {
namespace {

enum Block { kMinimum, kRange, kCutoff, kGamma, kToe, kBlocks };
constexpr const char* kBlockNames[] = {"minimum_luminance", "luminance_range", "cutoff_drive",
                                       "gamma", "toe_drive"};

// Residual root_weight (L(v; L0, L1, v0, gamma, toe) - reading), [1]; parameter blocks L0, L1, v0,
// gamma and toe, [1] each, so that any of them can be held.
struct LevelResidual final : ceres::SizedCostFunction<1, 1, 1, 1, 1, 1> {
  explicit LevelResidual(const WeightedReading& weighted_reading) : reading(weighted_reading) {}

  // The caller owns it, as ceres::Problem expects.
  static ceres::CostFunction* Create(const WeightedReading& reading) {
    return new LevelResidual(reading);
  }

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    const Activation activation{*parameters[kMinimum], *parameters[kRange], *parameters[kCutoff],
                                *parameters[kGamma], *parameters[kToe]};
    residuals[0] = reading.root_weight * (activation.Luminance(reading.drive) - reading.luminance);
    if (jacobians == nullptr) return true;
    const std::array<double, 4> gradient = activation.LuminanceGradient(reading.drive);
    for (int i = 0; i < kToe; ++i) {
      if (jacobians[i] != nullptr) jacobians[i][0] = reading.root_weight * gradient[i];
    }
    if (jacobians[kToe] != nullptr) {
      jacobians[kToe][0] = reading.root_weight * activation.LuminanceByToe(reading.drive);
    }
    return true;
  }

  const WeightedReading reading;
};

constexpr int kDrivesAboveCutoff = 2;    // fewer would leave range and gamma to one reading
constexpr double kSmallestRange = 1e-9;  // of white
constexpr double kLargestToe = 0.9;      // nearer to white little is left to tell the power by
constexpr double kAtBound = 1e-9;        // closer than this, a parameter is called at its bound

struct Bounds {
  double lower = 0;
  double upper = 0;
};

// Luminance in units of white and residuals of order 1, so that the solver's tolerances mean the
// same from 1e-4 to 1e5 cd/m2.
struct Scale {
  double luminance = 1;
  double root_weight = 1;
};

Scale ScaleOf(const ActivationProblem& problem) {
  Scale scale{0, 0};
  for (const WeightedReading& reading : problem.readings) {
    scale.luminance = std::max(scale.luminance, reading.luminance);
    scale.root_weight = std::max(scale.root_weight, reading.root_weight * reading.luminance);
  }
  return scale;
}

std::array<Bounds, kBlocks> BoundsOf(const ActivationProblem& problem) {
  const std::vector<double> drives = problem.Drives();
  const double last_cutoff = drives[drives.size() - 1 - kDrivesAboveCutoff];
  return {
      {{0, 1}, {kSmallestRange, 1e6}, {0, last_cutoff}, {kGammaMin, kGammaMax}, {0, kLargestToe}}};
}

ceres::Solver::Options SolverOptions() {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.logging_type = ceres::SILENT;
  options.max_num_iterations = 500;
  options.function_tolerance = 1e-15;
  options.gradient_tolerance = 1e-15;
  options.parameter_tolerance = 1e-12;
  return options;
}

// A scaled copy of the problem, minimised from one start after the other.
class Minimizer {
 public:
  explicit Minimizer(const ActivationProblem& problem)
      : scale_(ScaleOf(problem)), bounds_(BoundsOf(problem)) {
    for (const WeightedReading& reading : problem.readings) {
      problem_.AddResidualBlock(
          LevelResidual::Create({reading.drive, reading.luminance / scale_.luminance,
                                 reading.root_weight * scale_.luminance / scale_.root_weight}),
          nullptr, &values_[kMinimum], &values_[kRange], &values_[kCutoff], &values_[kGamma],
          &values_[kToe]);
    }
    for (int i = 0; i < kBlocks; ++i) {
      problem_.SetParameterLowerBound(&values_[i], 0, bounds_[i].lower);
      problem_.SetParameterUpperBound(&values_[i], 0, bounds_[i].upper);
    }
    const bool has_toe = problem.model == ActivationModel::kSrgbLike;
    if (has_toe || problem.model == ActivationModel::kPowerOffset) {
      problem_.SetParameterBlockConstant(&values_[kCutoff]);
    }
    if (!has_toe) problem_.SetParameterBlockConstant(&values_[kToe]);
  }

  ceres::Solver::Summary MinimizeFrom(const Activation& start) {
    values_ = {start.minimum_luminance / scale_.luminance, start.luminance_range / scale_.luminance,
               start.cutoff_drive, start.gamma, start.toe_drive};
    for (int i = 0; i < kBlocks; ++i) {
      values_[i] = std::clamp(values_[i], bounds_[i].lower, bounds_[i].upper);
    }
    ceres::Solver::Summary summary;
    ceres::Solve(SolverOptions(), &problem_, &summary);
    return summary;
  }

  Activation Result() const {
    return {values_[kMinimum] * scale_.luminance, values_[kRange] * scale_.luminance,
            values_[kCutoff], values_[kGamma], values_[kToe]};
  }

  // Of those that the problem leaves free.
  std::vector<std::string> AtBounds() const {
    std::vector<std::string> names;
    for (int i = 0; i < kBlocks; ++i) {
      if (problem_.IsParameterBlockConstant(&values_[i])) continue;
      const double gap = std::min(values_[i] - bounds_[i].lower, bounds_[i].upper - values_[i]);
      if (gap < kAtBound) names.emplace_back(kBlockNames[i]);
    }
    return names;
  }

 private:
  Scale scale_;
  std::array<Bounds, kBlocks> bounds_;
  std::array<double, kBlocks> values_{};
  ceres::Problem problem_;
};

std::string Describe(const ceres::Solver::Summary& summary,
                     const std::vector<std::string>& at_bounds) {
  std::string words =
      absl::StrCat("converged after ", summary.iterations.size(), " iterations: ", summary.message);
  if (!at_bounds.empty()) {
    absl::StrAppend(&words, "; at a bound: ", absl::StrJoin(at_bounds, ", "));
  }
  return words;
}

}  // namespace

absl::StatusOr<ActivationSolution> SolveActivation(const ActivationProblem& problem,
                                                   std::span<const Activation> starts) {
  Minimizer minimizer(problem);
  std::optional<ActivationSolution> best;
  std::string last_message = "no starting point";
  for (const Activation& start : starts) {
    const ceres::Solver::Summary summary = minimizer.MinimizeFrom(start);
    last_message = summary.message;
    if (summary.termination_type != ceres::CONVERGENCE) continue;
    const Activation activation = minimizer.Result();
    const double sum_of_squares = problem.SumOfSquares(activation);
    if (best && best->sum_of_squares <= sum_of_squares) continue;
    best = {activation, activation, sum_of_squares, Describe(summary, minimizer.AtBounds())};
  }
  if (best) return *std::move(best);
  return Rejected(NameOf(problem.model),
                  absl::StrCat("the fit converged from none of ", starts.size(),
                               " starting points, last: ", last_message),
                  "look at the series for readings out of line");
}

}  // namespace eyebox::fit
