#include "fit/field/common_exponent.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "absl/strings/str_cat.h"
#include "capture/base/parallel.h"
#include "capture/base/status.h"
#include "fit/base/activation.h"
#include "fit/base/relative_floor.h"
#include "fit/field/exponent_search.h"
#include "fit/field/kernels.h"
#include "fit/field/stack_blocks.h"
#include "fit/field/validate_stack.h"

namespace eyebox::fit {
namespace {

std::vector<double> RelativeWeights(const std::vector<double>& means) {
  const double floor = kRelativeFloor * *std::max_element(means.begin(), means.end());
  std::vector<double> weights;
  for (const double mean : means) weights.push_back(std::pow(std::max(mean, floor), -2.0));
  return weights;
}

// The regression of one location at a given gamma, and what gamma's uncertainty adds to it.
struct Line {
  std::vector<double> power, by_gamma, to_gain, to_offset;
  double gain_variance = 0;  // for residuals of variance 1 / weight
  double offset_variance = 0;
};

double Dot(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

Line LineAt(double gamma, std::span<const double> drives, const std::vector<double>& weights) {
  Line line;
  const Activation activation{0, 1, 0, gamma};
  double total = 0;
  for (size_t i = 0; i < drives.size(); ++i) {
    const std::array<double, 4> gradient = activation.LuminanceGradient(drives[i]);
    line.power.push_back(gradient[1]);
    line.by_gamma.push_back(gradient[3]);
    total += weights[i];
  }
  const double mean = Dot(weights, line.power) / total;
  double scatter = 0;
  for (size_t i = 0; i < drives.size(); ++i) {
    scatter += weights[i] * (line.power[i] - mean) * (line.power[i] - mean);
  }
  for (size_t i = 0; i < drives.size(); ++i) {
    line.to_gain.push_back(weights[i] * (line.power[i] - mean) / scatter);
    line.to_offset.push_back(weights[i] / total - mean * line.to_gain[i]);
  }
  line.gain_variance = 1 / scatter;
  line.offset_variance = 1 / total + mean * mean / scatter;
  return line;
}

struct LineWeights {
  const std::vector<double>& fitted;
  const std::vector<double>& relative;
};

LineSolver SolverOf(const Line& line, const LineWeights& weights, double location_freedom,
                    double gamma_variance) {
  LineSolver solver;
  solver.levels = static_cast<int>(line.power.size());
  solver.to_gain = line.to_gain.data();
  solver.to_offset = line.to_offset.data();
  solver.power = line.power.data();
  solver.weight = weights.fitted.data();
  solver.relative_weight = weights.relative.data();
  solver.gain_variance = line.gain_variance / location_freedom;
  solver.offset_variance = line.offset_variance / location_freedom;
  solver.gain_variance_of_gamma = gamma_variance * std::pow(Dot(line.to_gain, line.by_gamma), 2);
  solver.offset_variance_of_gamma =
      gamma_variance * std::pow(Dot(line.to_offset, line.by_gamma), 2);
  return solver;
}

// Blocks always have kBlockLocations places in the maps, which end on a multiple of it.
void Resize(size_t locations, CommonExponentFit& fit) {
  for (auto* map : {&fit.gain, &fit.gain_sigma, &fit.offset, &fit.offset_sigma}) {
    map->resize(locations);
  }
}

SquaredResiduals FitLines(const FieldStack& stack, const LineSolver& solver,
                          CommonExponentFit& fit) {
  const size_t locations = stack.LocationCount();
  Resize((locations + kBlockLocations - 1) / kBlockLocations * kBlockLocations, fit);
  std::vector<SquaredResiduals> pieces(static_cast<size_t>(PieceCount(stack)));
  ForEachInParallel(PieceCount(stack), [&](int i) {
    StackBlocks blocks(stack, i);
    SquaredResiduals squared;  // of its own: neighbours in `pieces` share a cache line
    while (blocks.Next()) {
      const size_t begin = blocks.begin();
      BestKernels().fit_lines(blocks.values(), solver,
                              {fit.gain.data() + begin, fit.gain_sigma.data() + begin,
                               fit.offset.data() + begin, fit.offset_sigma.data() + begin},
                              squared);
    }
    pieces[i] = squared;
  });
  SquaredResiduals squared;
  for (const SquaredResiduals& piece : pieces) {
    squared.weighted += piece.weighted;
    squared.relative += piece.relative;
  }
  Resize(locations, fit);
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  for (size_t i = 0; i < stack.valid.size(); ++i) {
    if (stack.valid[i] != 0) continue;
    fit.gain[i] = fit.gain_sigma[i] = fit.offset[i] = fit.offset_sigma[i] = kNaN;
  }
  return squared;
}

double GammaVariance(const ExponentOptimum& optimum, double sum_of_squares, double freedom) {
  return 2 * sum_of_squares / (freedom * optimum.curvature);
}

absl::Status CheckOptimum(const ExponentOptimum& optimum, const CommonExponentOptions& options) {
  if (!optimum.at_limit && optimum.curvature > 0) return absl::OkStatus();
  return Rejected(
      "common exponent",
      absl::StrCat("the sum of squares has no minimum between gamma ", options.gamma_min, " and ",
                   options.gamma_max, ", least at ", optimum.gamma),
      "check the order of the levels, and that dark frames were subtracted");
}

}  // namespace

absl::StatusOr<CommonExponentFit> FitCommonExponent(const FieldStack& stack,
                                                    const CommonExponentOptions& options) {
  EYEBOX_RETURN_IF_ERROR(ValidateStack(stack));
  EYEBOX_RETURN_IF_ERROR(ValidateOptions(stack, options));
  const StackMoments moments = MeasureMoments(stack);
  EYEBOX_RETURN_IF_ERROR(ValidateMoments(stack, moments));
  const std::vector<double> relative = RelativeWeights(moments.means);
  const std::vector<double>& weights =
      options.level_weights.empty() ? relative : options.level_weights;
  const ExponentOptimum optimum =
      FindExponent({stack.drives, weights, moments.products, options.gamma_min, options.gamma_max});
  EYEBOX_RETURN_IF_ERROR(CheckOptimum(optimum, options));

  const auto locations = static_cast<double>(moments.locations);
  const auto levels = static_cast<double>(stack.drives.size());
  CommonExponentFit fit;
  fit.gamma = optimum.gamma;
  fit.locations = moments.locations;
  fit.degrees_of_freedom = locations * (levels - 2) - 1;
  const double freedom = fit.degrees_of_freedom;
  const Line line = LineAt(optimum.gamma, stack.drives, weights);
  const LineSolver solver = SolverOf(line, {weights, relative}, freedom / locations,
                                     GammaVariance(optimum, optimum.sum_of_squares, freedom));
  const SquaredResiduals squared = FitLines(stack, solver, fit);
  // From the residuals themselves: the matrix cannot tell them from its roundings below 1e-7.
  fit.gamma_sigma = std::sqrt(GammaVariance(optimum, squared.weighted, freedom));
  fit.weighted_sum_of_squares = squared.weighted;
  fit.rms_relative = std::sqrt(squared.relative / (locations * levels));
  fit.termination = absl::StrCat(
      "the slope of the sum of squares changes sign at gamma to the last "
      "digit, after ",
      optimum.evaluations, " evaluations");
  return fit;
}

}  // namespace eyebox::fit
