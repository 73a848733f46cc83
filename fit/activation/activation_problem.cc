#include "fit/activation/activation_problem.h"

#include <algorithm>
#include <array>

namespace eyebox::fit {
namespace {

constexpr double kStartingGammas[] = {1, 2.2, 4};
constexpr double kStartingToes[] = {0.02, 0.2};
// Two parameters of a spline beyond the gamma fit's four are the least, and cross-validation takes
// two drives away.
constexpr size_t kFewestSplineDrives = 8;
constexpr double kDarkShare =
    0.05;  // of white: a cutoff is sought below the first brighter reading

bool HasCutoff(ActivationModel model) {
  return model == ActivationModel::kGammaWithCutoff || model == ActivationModel::kMonotoneSpline;
}

std::vector<double> StartingCutoffs(const ActivationProblem& problem) {
  std::vector<double> cutoffs = {0};
  if (!HasCutoff(problem.model)) return cutoffs;
  const double white = problem.readings.back().luminance;
  double previous = 0;
  for (const WeightedReading& reading : problem.readings) {
    if (reading.drive > previous) cutoffs.push_back(0.5 * (previous + reading.drive));
    previous = reading.drive;
    if (reading.luminance > kDarkShare * white) break;
  }
  return cutoffs;
}

struct WeightedMeans {
  double h = 0;
  double luminance = 0;
};

WeightedMeans MeansOf(const ActivationProblem& problem, const Activation& shape) {
  double weights = 0;
  WeightedMeans sums;
  for (const WeightedReading& reading : problem.readings) {
    const double weight = reading.root_weight * reading.root_weight;
    weights += weight;
    sums.h += weight * shape.H(reading.drive);
    sums.luminance += weight * reading.luminance;
  }
  return {sums.h / weights, sums.luminance / weights};
}

// The regression of luminance on h about a given point.
double SlopeAbout(const ActivationProblem& problem, const Activation& shape,
                  const WeightedMeans& about) {
  double products = 0;
  double squares = 0;
  for (const WeightedReading& reading : problem.readings) {
    const double weight = reading.root_weight * reading.root_weight;
    const double h = shape.H(reading.drive) - about.h;
    products += weight * h * (reading.luminance - about.luminance);
    squares += weight * h * h;
  }
  return squares > 0 ? products / squares : 0;
}

Activation WithBestLuminances(const ActivationProblem& problem, Activation shape) {
  const WeightedMeans means = MeansOf(problem, shape);
  shape.luminance_range = SlopeAbout(problem, shape, means);
  shape.minimum_luminance = means.luminance - shape.luminance_range * means.h;
  if (shape.minimum_luminance < 0) {
    shape.minimum_luminance = 0;
    shape.luminance_range = SlopeAbout(problem, shape, {0, 0});
  }
  if (!(shape.luminance_range > 0)) shape.luminance_range = problem.readings.back().luminance;
  return shape;
}

}  // namespace

size_t ActivationProblem::FewestDrives() const {
  switch (model) {
    case ActivationModel::kPowerOffset:
      return 4;
    case ActivationModel::kMonotoneSpline:
      return kFewestSplineDrives;
    case ActivationModel::kGammaWithCutoff:
    case ActivationModel::kSrgbLike:
      break;
  }
  return 5;
}

ActivationProblem ActivationProblem::Without(std::span<const double> drives) const {
  ActivationProblem rest = *this;
  std::erase_if(rest.readings, [&](const WeightedReading& reading) {
    return std::find(drives.begin(), drives.end(), reading.drive) != drives.end();
  });
  return rest;
}

std::vector<double> ActivationProblem::Drives() const {
  std::vector<double> drives;
  for (const WeightedReading& reading : readings) {
    if (drives.empty() || reading.drive > drives.back()) drives.push_back(reading.drive);
  }
  return drives;
}

double ActivationProblem::SumOfSquares(const Activation& activation) const {
  double sum = 0;
  for (const WeightedReading& reading : readings) {
    const double residual =
        reading.root_weight * (activation.Luminance(reading.drive) - reading.luminance);
    sum += residual * residual;
  }
  return sum;
}

std::vector<double> ParameterGradient(ActivationModel model, const Activation& activation,
                                      double drive) {
  const std::array<double, 4> common = activation.LuminanceGradient(drive);
  std::vector<double> gradient(common.begin(), common.end());
  if (!HasCutoff(model)) gradient[2] = 0;
  if (model == ActivationModel::kSrgbLike) gradient.push_back(activation.LuminanceByToe(drive));
  if (model == ActivationModel::kMonotoneSpline) {
    const std::vector<double> by_warp = activation.LuminanceByWarp(drive);
    gradient.insert(gradient.end(), by_warp.begin(), by_warp.end() - 1);
  }
  return gradient;
}

std::vector<int> FreeParameters(ActivationModel model, const Activation& activation) {
  std::vector<int> free = {0, 1};
  if (HasCutoff(model)) free.push_back(2);
  free.push_back(3);
  const auto count = static_cast<int>(ParameterGradient(model, activation, 1).size());
  for (int i = 4; i < count; ++i) free.push_back(i);
  return free;
}

std::vector<Activation> StartingPoints(const ActivationProblem& problem) {
  std::vector<Activation> starts;
  for (const double cutoff : StartingCutoffs(problem)) {
    for (const double gamma : kStartingGammas) {
      starts.push_back(WithBestLuminances(problem, {0, 1, cutoff, gamma}));
      if (problem.model != ActivationModel::kSrgbLike) continue;
      for (const double toe : kStartingToes) {
        starts.push_back(WithBestLuminances(problem, {0, 1, cutoff, gamma, toe}));
      }
    }
  }
  return starts;
}

}  // namespace eyebox::fit
