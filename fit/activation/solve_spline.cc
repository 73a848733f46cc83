// The monotone spline on what a gamma fit leaves.
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "absl/strings/str_cat.h"
#include "capture/base/status.h"
#include "ceres/cost_function.h"
#include "ceres/problem.h"
#include "ceres/solver.h"
#include "fit/activation/activation_problem.h"

namespace eyebox::fit {
namespace {

constexpr int kFewestKnots = 2;
constexpr int kMostKnots = 6;
constexpr int kMostFolds = 10;  // of cross-validation; each drive alone up to here
constexpr double kLargestLogSlope = 5;
constexpr double kSmallestRange = 1e-9;  // of white

double Base(const Activation& activation, double drive) {
  return std::max(drive - activation.cutoff_drive, 0.0) / (1 - activation.cutoff_drive);
}

// From 0 to 1, as many drives in each piece.
std::vector<double> KnotsFor(const ActivationProblem& problem, const Activation& gamma_fit,
                             int knots) {
  std::vector<double> inside;
  for (const double drive : problem.Drives()) {
    const double x = Base(gamma_fit, drive);
    if (x > 0 && x < 1) inside.push_back(x);
  }
  std::vector<double> places = {0};
  for (int j = 1; j + 1 < knots; ++j) {
    const double place = (static_cast<double>(inside.size()) + 1) * j / (knots - 1) - 1;
    const auto low = static_cast<size_t>(std::max(place, 0.0));
    const size_t high = std::min(low + 1, inside.size() - 1);
    const double share = place - static_cast<double>(low);
    places.push_back(inside[low] + share * (inside[high] - inside[low]));
  }
  places.push_back(1);
  return places;
}

// Residuals root_weight (L(v) - reading), [readings]; one parameter block L0, L1 and the log slopes
// at all knots but white's, which is 0; luminances in units of white.
struct SplineResiduals final : ceres::CostFunction {
  SplineResiduals(const ActivationProblem& spline_problem, const Activation& gamma_fit,
                  const std::vector<double>& knots, double luminance)
      : problem(spline_problem), shape(gamma_fit), places(knots), white(luminance) {
    set_num_residuals(static_cast<int>(problem.readings.size()));
    mutable_parameter_block_sizes()->push_back(1 + static_cast<int>(places.size()));
  }

  Activation At(const double* values) const {
    std::vector<double> log_slopes(values + 2, values + 1 + places.size());
    log_slopes.push_back(0);
    Activation activation = shape;
    activation.minimum_luminance = white * values[0];
    activation.luminance_range = white * values[1];
    activation.warp = MonotoneWarp::FromLogSlopes(places, log_slopes);
    return activation;
  }

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    const Activation activation = At(parameters[0]);
    const size_t columns = 1 + places.size();
    for (size_t i = 0; i < problem.readings.size(); ++i) {
      const WeightedReading& reading = problem.readings[i];
      residuals[i] =
          reading.root_weight * (activation.Luminance(reading.drive) - reading.luminance);
      if (jacobians == nullptr || jacobians[0] == nullptr) continue;
      double* row = jacobians[0] + i * columns;
      row[0] = reading.root_weight * white;
      row[1] = row[0] * activation.H(reading.drive);
      const std::vector<double> by_warp = activation.LuminanceByWarp(reading.drive);
      for (size_t k = 2; k < columns; ++k) row[k] = reading.root_weight * by_warp[k - 2];
    }
    return true;
  }

  const ActivationProblem& problem;
  const Activation& shape;
  const std::vector<double>& places;
  const double white;
};

ceres::Solver::Options SolverOptions() {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.logging_type = ceres::SILENT;
  options.max_num_iterations = 200;
  options.function_tolerance = 1e-14;
  options.gradient_tolerance = 1e-14;
  options.parameter_tolerance = 1e-11;
  return options;
}

// Every fold-th of the interior drives, beginning with the first, second, ...
std::vector<std::vector<double>> FoldsOf(const std::vector<double>& drives) {
  const size_t interior = drives.size() - 2;
  const size_t folds = std::min<size_t>(interior, kMostFolds);
  std::vector<std::vector<double>> left_out(folds);
  for (size_t i = 0; i < interior; ++i) left_out[i % folds].push_back(drives[i + 1]);
  return left_out;
}

double SquaredErrors(const ActivationProblem& problem, const std::vector<double>& drives,
                     const Activation& activation, double floor) {
  double sum = 0;
  for (const WeightedReading& reading : problem.readings) {
    if (std::find(drives.begin(), drives.end(), reading.drive) == drives.end()) continue;
    const double error = (activation.Luminance(reading.drive) - reading.luminance) /
                         std::max(reading.luminance, floor);
    sum += error * error;
  }
  return sum;
}

}  // namespace

absl::StatusOr<ActivationSolution> SolveSpline(const ActivationProblem& problem,
                                               const Activation& gamma_fit, int knots) {
  const std::vector<double> places = KnotsFor(problem, gamma_fit, knots);
  const double white = gamma_fit.minimum_luminance + gamma_fit.luminance_range;
  SplineResiduals residuals(problem, gamma_fit, places, white);
  std::vector<double> values(1 + knots, 0.0);
  values[0] = gamma_fit.minimum_luminance / white;
  values[1] = gamma_fit.luminance_range / white;
  ceres::Problem::Options ownership;
  ownership.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem least_squares(ownership);
  least_squares.AddResidualBlock(&residuals, nullptr, values.data());
  least_squares.SetParameterLowerBound(values.data(), 0, 0);
  least_squares.SetParameterLowerBound(values.data(), 1, kSmallestRange);
  for (int k = 2; k <= knots; ++k) {
    least_squares.SetParameterLowerBound(values.data(), k, -kLargestLogSlope);
    least_squares.SetParameterUpperBound(values.data(), k, kLargestLogSlope);
  }
  ceres::Solver::Summary summary;
  ceres::Solve(SolverOptions(), &least_squares, &summary);
  if (summary.termination_type != ceres::CONVERGENCE) {
    return Rejected(
        NameOf(problem.model),
        absl::StrCat("the spline of ", knots, " knots did not converge: ", summary.message),
        "look at the series for readings out of line");
  }
  ActivationSolution solution{residuals.At(values.data()), gamma_fit, 0, ""};
  solution.sum_of_squares = problem.SumOfSquares(solution.activation);
  solution.termination = absl::StrCat("spline of ", knots,
                                      " knots on the residual of a gamma fit: ", "converged after ",
                                      summary.iterations.size(), " iterations: ", summary.message);
  return solution;
}

absl::StatusOr<int> ChooseKnotCount(const ActivationProblem& problem, const Activation& gamma_fit,
                                    double floor) {
  const std::vector<double> drives = problem.Drives();
  const std::vector<std::vector<double>> folds = FoldsOf(drives);
  const auto most_left_out = static_cast<int>(folds.front().size());
  // As many parameters, 3 + knots, as a fold leaves drives would fit anything.
  const int most = std::min(kMostKnots, static_cast<int>(drives.size()) - most_left_out - 4);
  std::vector<double> sums(std::max(most, kFewestKnots) + 1, 0.0);
  if (most <= kFewestKnots) return kFewestKnots;
  for (const std::vector<double>& fold : folds) {
    const ActivationProblem rest = problem.Without(fold);
    EYEBOX_ASSIGN_OR_RETURN(const ActivationSolution gamma_without,
                            SolveActivation(rest, {&gamma_fit, 1}));
    for (int knots = kFewestKnots; knots <= most; ++knots) {
      const auto spline = SolveSpline(rest, gamma_without.activation, knots);
      sums[knots] += spline.ok() ? SquaredErrors(problem, fold, spline->activation, floor)
                                 : std::numeric_limits<double>::infinity();
    }
  }
  const auto least = std::min_element(sums.begin() + kFewestKnots, sums.end());
  return static_cast<int>(least - sums.begin());
}

absl::StatusOr<ActivationSolution> SolveModel(const ActivationProblem& problem,
                                              std::span<const Activation> starts, double floor) {
  EYEBOX_ASSIGN_OR_RETURN(ActivationSolution gamma, SolveActivation(problem, starts));
  if (problem.model != ActivationModel::kMonotoneSpline) return gamma;
  EYEBOX_ASSIGN_OR_RETURN(const int knots, ChooseKnotCount(problem, gamma.activation, floor));
  return SolveSpline(problem, gamma.activation, knots);
}

}  // namespace eyebox::fit
