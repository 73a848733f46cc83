#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "capture/base/status.h"
#include "ceres/cost_function.h"
#include "ceres/problem.h"
#include "ceres/solver.h"
#include "fit/scatter/glare_model.h"

namespace eyebox::fit {
namespace {

constexpr double kAtBound = 1e-6;

// Residuals (predicted - measured) / sigma, [readings]; one block: the free coordinates.
class GlareResiduals final : public ceres::CostFunction {
 public:
  GlareResiduals(const GlareModel& model, std::vector<int> free, const GlareCoordinates& held)
      : model_(model), free_(std::move(free)), held_(held) {
    set_num_residuals(static_cast<int>(model.series().readings.size()));
    mutable_parameter_block_sizes()->push_back(static_cast<int>(free_.size()));
  }

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    GlareCoordinates coordinates = held_;
    for (size_t k = 0; k < free_.size(); ++k) coordinates[free_[k]] = parameters[0][k];
    const GlareEvaluation found = model_.Evaluate(coordinates);
    std::ranges::copy(found.residuals, residuals);
    const bool finite =
        std::ranges::all_of(found.residuals, [](double r) { return std::isfinite(r); });
    if (!finite || jacobians == nullptr || jacobians[0] == nullptr) return finite;
    double* next = jacobians[0];
    for (size_t i = 0; i < found.residuals.size(); ++i) {
      for (const int j : free_) *next++ = found.jacobian[i * kGlareParameters + j];
    }
    return true;
  }

 private:
  const GlareModel& model_;
  std::vector<int> free_;
  GlareCoordinates held_;
};

struct Bounds {
  double lower = 0;
  double upper = 0;
};

std::array<Bounds, kGlareParameters> BoundsOf(const GlareModel& model) {
  const double reach = std::log(model.options().reach_deg);
  const Bounds share{-18, 6};
  return {{{std::log(1e-4), reach - 0.01},
           share,
           {std::log(1e-3), reach},
           {std::log(0.5), std::log(15)},
           share,
           {-40, 40},
           {-1e6, 1e6}}};
}

ceres::Solver::Options SolverOptions() {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.logging_type = ceres::SILENT;
  options.max_num_iterations = 300;
  options.function_tolerance = 1e-10;
  options.gradient_tolerance = 1e-10;
  options.parameter_tolerance = 1e-9;
  return options;
}

std::string Describe(const GlareModel& model, const ceres::Solver::Summary& summary,
                     const GlareCoordinates& coordinates) {
  std::vector<std::string> at_bounds;
  const auto bounds = BoundsOf(model);
  for (const int i : model.Free()) {
    const double gap = std::min(coordinates[i] - bounds[i].lower, bounds[i].upper - coordinates[i]);
    if (gap < kAtBound) at_bounds.emplace_back(kGlareNames[i]);
  }
  std::string words =
      absl::StrCat("converged after ", summary.iterations.size(), " iterations: ", summary.message);
  if (!at_bounds.empty()) {
    absl::StrAppend(&words, "; at a bound: ", absl::StrJoin(at_bounds, ", "));
  }
  return words;
}

struct Attempt {
  ceres::Solver::Summary summary;
  GlareCoordinates coordinates{};
};

Attempt MinimizeFrom(const GlareModel& model, const GlareCoordinates& start) {
  const std::vector<int> free = model.Free();
  const auto bounds = BoundsOf(model);
  std::vector<double> block;
  for (const int i : free) {
    block.push_back(std::clamp(start[i], bounds[i].lower, bounds[i].upper));
  }
  ceres::Problem problem;
  problem.AddResidualBlock(new GlareResiduals(model, free, start), nullptr, block.data());
  for (size_t k = 0; k < free.size(); ++k) {
    problem.SetParameterLowerBound(block.data(), static_cast<int>(k), bounds[free[k]].lower);
    problem.SetParameterUpperBound(block.data(), static_cast<int>(k), bounds[free[k]].upper);
  }
  Attempt attempt{{}, start};
  ceres::Solve(SolverOptions(), &problem, &attempt.summary);
  for (size_t k = 0; k < free.size(); ++k) attempt.coordinates[free[k]] = block[k];
  return attempt;
}

}  // namespace

absl::StatusOr<GlareSolution> SolveGlare(const GlareModel& model,
                                         const std::vector<GlareCoordinates>& starts) {
  std::optional<GlareSolution> best;
  std::string last_message = "no starting point";
  for (const GlareCoordinates& start : starts) {
    const Attempt attempt = MinimizeFrom(model, start);
    last_message = attempt.summary.message;
    if (attempt.summary.termination_type != ceres::CONVERGENCE) continue;
    const double chi_square = 2 * attempt.summary.final_cost;
    if (best && best->chi_square <= chi_square) continue;
    best = {attempt.coordinates, chi_square, Describe(model, attempt.summary, attempt.coordinates)};
  }
  if (best) return *std::move(best);
  return Rejected(
      model.series().source,
      absl::StrCat("the scatter fit converged from no starting point, last: ", last_message),
      "look at the readings for values out of line");
}

}  // namespace eyebox::fit
