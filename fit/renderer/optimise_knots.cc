#include <ceres/ceres.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_format.h"
#include "capture/base/status.h"
#include "fit/renderer/delta_sweep.h"

namespace eyebox::fit {
namespace {

// LogC is a logarithm of u plus this (0.047996 / 5.555556).
constexpr double kLogOffset = 0.047996 / 5.555556;
constexpr double kLeastPeak = 0.1;
constexpr int kStride = 4;

double AxisOf(double u) { return std::log(u + kLogOffset); }

struct Sample {
  double place = 0;  // AxisOf(u)
  double t = 0;
};

// Residuals of the answers to one delta cube: tent minus t. Parameters: the place of the first
// knot, then the logarithms of the gaps to the next; `knot` counts among those found.
class TentResidual {
 public:
  TentResidual(std::vector<Sample> samples, size_t knot, size_t count)
      : samples_(std::move(samples)), knot_(knot), count_(count) {}

  template <typename T>
  bool operator()(const T* const* parameters, T* residuals) const {
    const T* row = parameters[0];
    T place = row[0];
    T below = place;
    T above = place;
    for (size_t i = 1; i <= std::min(knot_ + 1, count_ - 1); ++i) {
      const T next = above + exp(row[i]);
      if (i <= knot_) {
        below = place;
        place = next;
      }
      above = next;
    }
    for (size_t i = 0; i < samples_.size(); ++i) {
      residuals[i] = Tent(T(samples_[i].place), below, place, above) - T(samples_[i].t);
    }
    return true;
  }

 private:
  // Beyond the last knot the table is constant; below the first of those found it is too, as far as
  // the sweep can tell.
  template <typename T>
  T Tent(const T& x, const T& below, const T& place, const T& above) const {
    if (x <= place) return knot_ == 0 ? T(1) : x <= below ? T(0) : (x - below) / (place - below);
    if (knot_ + 1 == count_) return T(1);
    return x >= above ? T(0) : (above - x) / (above - place);
  }

  std::vector<Sample> samples_;
  size_t knot_;
  size_t count_;
};

// The middle of the places where the answer is largest.
void FindPeak(const std::vector<DeltaReading>& readings, RecoveredKnot& knot) {
  double largest = 0;
  for (const DeltaReading& reading : readings) largest = std::max(largest, reading.t);
  if (largest < kLeastPeak) {
    knot.why_not = absl::StrFormat("no u is mapped to it: the largest answer is %.3g", largest);
    return;
  }
  double low = 0;
  double high = 0;
  bool is_first = true;
  for (const DeltaReading& reading : readings) {
    if (reading.t < largest) continue;
    low = is_first ? reading.u : std::min(low, reading.u);
    high = is_first ? reading.u : std::max(high, reading.u);
    is_first = false;
  }
  knot.is_found = true;
  knot.u_at_peak = std::exp((AxisOf(low) + AxisOf(high)) / 2) - kLogOffset;
}

// A plateau at either end is where the table is constant: its knot is the inner edge.
void CutPlateau(const std::vector<DeltaReading>& readings, bool is_last, RecoveredKnot& knot) {
  double largest = 0;
  for (const DeltaReading& reading : readings) largest = std::max(largest, reading.t);
  bool is_first = true;
  for (const DeltaReading& reading : readings) {
    if (reading.t < largest) continue;
    const double u = reading.u;
    knot.u_at_peak = is_first  ? u
                     : is_last ? std::min(knot.u_at_peak, u)
                               : std::max(knot.u_at_peak, u);
    is_first = false;
  }
}

struct Problem {
  std::vector<size_t> found;  // indices of knots
  std::vector<double> row;    // what is fitted
  int residuals = 0;
};

absl::StatusOr<Problem> StartingPoint(const std::vector<RecoveredKnot>& knots) {
  Problem problem;
  double before = 0;
  for (size_t i = 0; i < knots.size(); ++i) {
    if (!knots[i].is_found) continue;
    const double place = AxisOf(knots[i].u_at_peak);
    if (!problem.found.empty() && !(place > before)) {
      return Rejected(absl::StrFormat("delta cube %d", knots[i].cube),
                      "its peak lies no higher than the one before",
                      "sweep u in finer steps, and check which cube was which");
    }
    problem.row.push_back(problem.found.empty() ? place : std::log(place - before));
    problem.found.push_back(i);
    before = place;
  }
  if (problem.found.size() >= 3) return problem;
  return Rejected("sweep", "fewer than three knots answer", "sweep u over 1e-4 to 100");
}

// Places and their standard deviations from the row that was fitted, to first order.
void StoreKnots(const Problem& problem, const std::vector<double>& covariance,
                std::vector<RecoveredKnot>& knots) {
  const size_t count = problem.row.size();
  std::vector<double> slopes(count, 0.0);
  double place = 0;
  for (size_t k = 0; k < count; ++k) {
    slopes[k] = k == 0 ? 1 : std::exp(problem.row[k]);
    place += k == 0 ? problem.row[0] : slopes[k];
    double variance = 0;
    for (size_t i = 0; i <= k; ++i) {
      for (size_t j = 0; j <= k; ++j) variance += slopes[i] * covariance[i * count + j] * slopes[j];
    }
    RecoveredKnot& knot = knots[problem.found[k]];
    knot.u_optimised = std::exp(place) - kLogOffset;
    knot.sigma = std::exp(place) * std::sqrt(std::max(variance, 0.0));
  }
}

absl::Status Optimise(const std::vector<std::vector<DeltaReading>>& by_cube, Problem& problem,
                      RecoveredKnots& result) {
  ceres::Problem ceres_problem;
  const size_t count = problem.found.size();
  for (size_t k = 0; k < count; ++k) {
    std::vector<Sample> samples;
    for (const DeltaReading& reading : by_cube[problem.found[k]]) {
      samples.push_back({AxisOf(reading.u), reading.t});
    }
    const int size = static_cast<int>(samples.size());
    auto* cost = new ceres::DynamicAutoDiffCostFunction<TentResidual, kStride>(
        new TentResidual(std::move(samples), k, count));
    cost->AddParameterBlock(static_cast<int>(count));
    cost->SetNumResiduals(size);
    ceres_problem.AddResidualBlock(cost, nullptr, problem.row.data());
    problem.residuals += size;
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
  options.max_num_iterations = 100;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &ceres_problem, &summary);
  result.termination = ceres::TerminationTypeToString(summary.termination_type);
  if (!summary.IsSolutionUsable()) return Rejected("knots", summary.message, "check the sweep");
  result.rms_residual = std::sqrt(2 * summary.final_cost / problem.residuals);
  ceres::Covariance covariance{ceres::Covariance::Options()};
  const std::vector<const double*> blocks = {problem.row.data()};
  if (!covariance.Compute(blocks, &ceres_problem)) {
    return Rejected("knots", "the sweep does not fix every knot", "sweep u in finer steps");
  }
  std::vector<double> matrix(count * count);
  covariance.GetCovarianceBlock(problem.row.data(), problem.row.data(), matrix.data());
  const double freedom = std::max(1.0, problem.residuals - static_cast<double>(count));
  for (double& element : matrix) element *= 2 * summary.final_cost / freedom;
  StoreKnots(problem, matrix, result.knots);
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<RecoveredKnots> RecoverKnots(const DeltaSweep& sweep) {
  std::vector<std::vector<DeltaReading>> by_cube(static_cast<size_t>(sweep.size));
  for (const DeltaReading& reading : sweep.readings) by_cube[reading.cube - 1].push_back(reading);
  RecoveredKnots result;
  for (size_t i = 0; i < by_cube.size(); ++i) {
    RecoveredKnot& knot = result.knots.emplace_back();
    knot.cube = static_cast<int>(i) + 1;
    if (by_cube[i].size() < 3) {
      return BadInput(absl::StrFormat("delta cube %d", knot.cube), "fewer than 3 readings",
                      "sweep u through every delta cube");
    }
    FindPeak(by_cube[i], knot);
  }
  const auto is_found = [](const RecoveredKnot& knot) { return knot.is_found; };
  const auto first = std::find_if(result.knots.begin(), result.knots.end(), is_found);
  if (first != result.knots.end()) {
    CutPlateau(by_cube[static_cast<size_t>(first - result.knots.begin())], false, *first);
    const auto last = std::find_if(result.knots.rbegin(), result.knots.rend(), is_found);
    CutPlateau(by_cube[static_cast<size_t>(last->cube - 1)], true, *last);
  }
  EYEBOX_ASSIGN_OR_RETURN(Problem problem, StartingPoint(result.knots));
  EYEBOX_RETURN_IF_ERROR(Optimise(by_cube, problem, result));
  return result;
}

}  // namespace eyebox::fit
