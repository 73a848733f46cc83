#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "capture/base/status.h"
#include "ceres/dynamic_autodiff_cost_function.h"
#include "ceres/problem.h"
#include "ceres/solver.h"
#include "fit/color/colour_forward.h"
#include "fit/color/colour_problem.h"

namespace eyebox::fit {
namespace {

constexpr double kLargestCutoff = 0.5;
constexpr double kGammaMin = 0.3;
constexpr double kGammaMax = 8;
constexpr double kLargestInteraction = 0.49;
constexpr double kAtBound = 1e-9;  // closer than this, a parameter is called at its bound
constexpr double kStartingCutoffs[] = {0, 0.08};
constexpr double kStartingGammas[] = {1.4, 2.2, 3.4};

// Residuals (x(v) - reading) / max(reading, floor), [3]; one parameter block, ColourParameter.
// Everything in units of the largest X, Y, Z.
struct ColourResidual {
  ColourModelKind kind;
  Rgb drive;
  Xyz reading;
  Xyz weight;

  template <typename T>
  bool operator()(T const* const* parameters, T* residuals) const {
    const std::array<T, 3> colour = ForwardColour(kind, parameters[0], drive);
    for (int c = 0; c < 3; ++c) residuals[c] = (colour[c] - T(reading[c])) * T(weight[c]);
    return true;
  }

  // The caller owns it, as ceres::Problem expects.
  static ceres::CostFunction* Create(const ColourProblem& problem, const ColourReading& reading) {
    auto residual = new ColourResidual{problem.kind, reading.drive, {}, {}};
    for (size_t c = 0; c < 3; ++c) {
      const double measured = reading.colour[c];
      residual->reading[c] = measured / problem.largest[c];
      residual->weight[c] = problem.largest[c] / std::max(measured, problem.floor[c]);
    }
    auto function = new ceres::DynamicAutoDiffCostFunction<ColourResidual, 8>(residual);
    function->AddParameterBlock(ParameterCount(problem.kind));
    function->SetNumResiduals(3);
    return function;
  }
};

// Background and primaries in units of the largest X, Y, Z (factor 1 / largest), or back.
void ScaleColours(const Xyz& factor, std::vector<double>& parameters) {
  for (int i = kBackground; i < kInteraction; ++i) parameters[i] *= factor[i % 3];
}

Xyz Reciprocal(const Xyz& values) { return {1 / values[0], 1 / values[1], 1 / values[2]}; }

ceres::Solver::Options SolverOptions() {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.logging_type = ceres::SILENT;
  options.max_num_iterations = 500;
  options.function_tolerance = 1e-13;
  options.gradient_tolerance = 1e-13;
  options.parameter_tolerance = 1e-11;
  return options;
}

class Minimizer {
 public:
  explicit Minimizer(const ColourProblem& problem)
      : problem_(problem), values_(ParameterCount(problem.kind)) {
    for (const ColourReading& reading : problem.readings) {
      ceres_.AddResidualBlock(ColourResidual::Create(problem, reading), nullptr, values_.data());
    }
    for (int k = 0; k < 3; ++k) {
      Bound(kCutoff + k, 0, kLargestCutoff);
      Bound(kGamma + k, kGammaMin, kGammaMax);
      ceres_.SetParameterLowerBound(values_.data(), kBackground + k, 0);
    }
    for (int i = kInteraction; i < static_cast<int>(values_.size()); ++i) {
      Bound(i, -kLargestInteraction, kLargestInteraction);
    }
  }

  ceres::Solver::Summary MinimizeFrom(const ColourModel& start) {
    std::vector<double> parameters = start.ToParameters();
    ScaleColours(Reciprocal(problem_.largest), parameters);
    std::ranges::copy(parameters, values_.begin());
    ceres::Solver::Summary summary;
    ceres::Solve(SolverOptions(), &ceres_, &summary);
    return summary;
  }

  ColourModel Result() const {
    std::vector<double> parameters = values_;
    ScaleColours(problem_.largest, parameters);
    return ColourModel::FromParameters(problem_.kind, parameters);
  }

  std::string Describe(const ceres::Solver::Summary& summary) const {
    std::string words = absl::StrCat("converged after ", summary.iterations.size(),
                                     " iterations: ", summary.message);
    const std::vector<std::string> names = ParameterNames(problem_.kind);
    std::vector<std::string> at_bounds;
    for (int i = 0; i < static_cast<int>(values_.size()); ++i) {
      const double lower = ceres_.GetParameterLowerBound(values_.data(), i);
      const double upper = ceres_.GetParameterUpperBound(values_.data(), i);
      if (std::min(values_[i] - lower, upper - values_[i]) < kAtBound)
        at_bounds.push_back(names[i]);
    }
    if (!at_bounds.empty()) {
      absl::StrAppend(&words, "; at a bound: ", absl::StrJoin(at_bounds, ", "));
    }
    return words;
  }

 private:
  void Bound(int index, double lower, double upper) {
    ceres_.SetParameterLowerBound(values_.data(), index, lower);
    ceres_.SetParameterUpperBound(values_.data(), index, upper);
  }

  const ColourProblem& problem_;
  std::vector<double> values_;
  ceres::Problem ceres_;
};

// The background and primaries that suit given activations best; false if the stimuli leave them
// undetermined.
bool FitColours(const ColourProblem& problem, ColourModel& model) {
  const auto rows = static_cast<Eigen::Index>(problem.readings.size());
  Eigen::MatrixXd activations(rows, 4);
  for (Eigen::Index row = 0; row < rows; ++row) {
    const Rgb a = model.Activations(problem.readings[row].drive);
    activations.row(row) << 1, a[0], a[1], a[2];
  }
  for (size_t c = 0; c < 3; ++c) {
    Eigen::MatrixXd weighted = activations;
    Eigen::VectorXd wanted(rows);
    for (Eigen::Index row = 0; row < rows; ++row) {
      const double measured = problem.readings[row].colour[c];
      const double weight = 1 / std::max(measured, problem.floor[c]);
      weighted.row(row) *= weight;
      wanted[row] = measured * weight;
    }
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(weighted);
    if (qr.rank() < 4) return false;
    const Eigen::Vector4d colours = qr.solve(wanted);
    model.background[c] = std::max(colours[0], 0.0);
    for (size_t k = 0; k < 3; ++k)
      model.primaries[k][c] = colours[static_cast<Eigen::Index>(k) + 1];
  }
  return true;
}

}  // namespace

Xyz ColourProblem::RelativeError(const ColourModel& model, const ColourReading& reading) const {
  const Xyz modelled = model.Colour(reading.drive);
  Xyz error = {};
  for (size_t c = 0; c < 3; ++c) {
    error[c] = (modelled[c] - reading.colour[c]) / std::max(reading.colour[c], floor[c]);
  }
  return error;
}

double ColourProblem::SumOfSquares(const ColourModel& model) const {
  double sum = 0;
  for (const ColourReading& reading : readings) {
    for (double error : RelativeError(model, reading)) sum += error * error;
  }
  return sum;
}

absl::StatusOr<std::vector<ColourModel>> ColourStartingPoints(const ColourProblem& problem) {
  std::vector<ColourModel> starts;
  for (double cutoff : kStartingCutoffs) {
    for (double gamma : kStartingGammas) {
      ColourModel start;
      start.kind = problem.kind;
      start.cutoff_drive = {cutoff, cutoff, cutoff};
      start.gamma = {gamma, gamma, gamma};
      start.interaction.assign(InteractionCount(problem.kind), 0);
      if (FitColours(problem, start)) starts.push_back(start);
    }
  }
  if (!starts.empty()) return starts;
  return Rejected(problem.source, "its stimuli do not tell red, green and blue apart",
                  "measure black, and each channel alone at several levels");
}

absl::StatusOr<ColourSolution> SolveColour(const ColourProblem& problem,
                                           std::span<const ColourModel> starts) {
  Minimizer minimizer(problem);
  std::optional<ColourSolution> best;
  std::string last_message = "no starting point";
  for (const ColourModel& start : starts) {
    const ceres::Solver::Summary summary = minimizer.MinimizeFrom(start);
    last_message = summary.message;
    if (summary.termination_type != ceres::CONVERGENCE) continue;
    const ColourModel model = minimizer.Result();
    const double sum_of_squares = problem.SumOfSquares(model);
    if (best && best->sum_of_squares <= sum_of_squares) continue;
    best = {model, sum_of_squares, minimizer.Describe(summary)};
  }
  if (best) return *std::move(best);
  return Rejected(
      problem.source,
      absl::StrCat("the ", std::string(NameOf(problem.kind)), " colour fit converged from none of ",
                   starts.size(), " starting points, last: ", last_message),
      "look at the series for readings out of line");
}

}  // namespace eyebox::fit
