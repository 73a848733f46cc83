#include "fit/field/shared_exponent.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "absl/strings/str_cat.h"
#include "capture/base/status.h"
#include "fit/base/activation.h"
#include "fit/base/relative_floor.h"
#include "fit/field/mask_groups.h"
#include "fit/field/shape_search.h"
#include "fit/field/validate_stack.h"

namespace eyebox::fit {
namespace {

constexpr char kStack[] = "field stack";

absl::Status ValidateWeights(const MaskedStack& stack, const FieldWeights& weights) {
  if (weights.levels.size() != stack.drives.size() ||
      weights.locations.size() != stack.LocationCount()) {
    return BadInput("field weights",
                    absl::StrCat("there are ", weights.levels.size(), " for levels and ",
                                 weights.locations.size(), " for locations; the stack has ",
                                 stack.drives.size(), " and ", stack.LocationCount()),
                    "give one per level and one per location");
  }
  const auto bad_level = [](double weight) { return !(weight > 0 && std::isfinite(weight)); };
  const auto bad_location = [](double weight) { return !(weight >= 0 && std::isfinite(weight)); };
  if (std::any_of(weights.levels.begin(), weights.levels.end(), bad_level)) {
    return BadInput("field weights", "one of a level is not above 0 and finite",
                    "leave a level out by its mask");
  }
  if (std::any_of(weights.locations.begin(), weights.locations.end(), bad_location)) {
    return BadInput("field weights", "one of a location is negative or not finite",
                    "give 0 to leave a location out");
  }
  return absl::OkStatus();
}

bool IsValid(const MaskedStack& stack, size_t place) {
  return stack.valid.empty() || stack.valid[place] != 0;
}

// k, delta and residuals of every location of the group, from its own readings.
void FitMembers(const MaskedStack& stack, const FieldWeights& weights, const MaskGroup& group,
                const Activation& shape, SharedExponentFit& fit) {
  const auto levels = static_cast<Eigen::Index>(group.levels.size());
  Eigen::MatrixXd basis(levels, 2);
  for (Eigen::Index k = 0; k < levels; ++k) {
    basis(k, 1) = std::sqrt(weights.levels[group.levels[k]]);
    basis(k, 0) = basis(k, 1) * shape.H(stack.drives[group.levels[k]]);
  }
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(basis);
  for (const size_t location : group.members) {
    Eigen::VectorXd values(levels);
    for (Eigen::Index k = 0; k < levels; ++k) {
      values[k] = basis(k, 1) * stack.luminance[group.levels[k] * stack.LocationCount() + location];
    }
    const Eigen::Vector2d line = qr.solve(values);
    const double squares = weights.locations[location] * (values - basis * line).squaredNorm();
    fit.gain[location] = line[0];
    fit.offset[location] = line[1];
    fit.rms[location] = std::sqrt(squares / static_cast<double>(levels));
    fit.weighted_sum_of_squares += squares;
  }
}

void SetSigmas(const ShapeOptimum& optimum, bool with_cutoff, SharedExponentFit& fit) {
  const double variance = fit.weighted_sum_of_squares / fit.degrees_of_freedom;
  if (!with_cutoff) {
    fit.gamma_sigma = std::sqrt(variance / optimum.curvature[0]);
    return;
  }
  const Eigen::Matrix2d curvature(optimum.curvature.data());
  const Eigen::Matrix2d covariance = variance * curvature.inverse();
  fit.gamma_sigma = std::sqrt(covariance(0, 0));
  fit.cutoff_sigma = std::sqrt(covariance(1, 1));
  fit.gamma_cutoff_covariance = covariance(0, 1);
}

absl::Status CheckOptimum(const ShapeOptimum& optimum, const SharedExponentOptions& options) {
  if (!optimum.converged) {
    return Rejected("common exponent",
                    absl::StrCat("the search did not come to rest in ", optimum.iterations,
                                 " steps, last at gamma ", optimum.gamma),
                    "look at the readings for levels out of line");
  }
  const double gamma = optimum.gamma;
  if (gamma > options.gamma_min * (1 + 1e-9) && gamma < options.gamma_max * (1 - 1e-9) &&
      optimum.curvature[0] > 0) {
    return absl::OkStatus();
  }
  return Rejected("common exponent",
                  absl::StrCat("the sum of squares has no minimum between gamma ",
                               options.gamma_min, " and ", options.gamma_max, ", least at ", gamma),
                  "check the order of the levels, and that dark frames were subtracted");
}

// Each level's mean over the locations with a valid reading there.
std::vector<double> LevelMeans(const MaskedStack& stack) {
  const size_t locations = stack.LocationCount();
  std::vector<double> means;
  for (size_t level = 0; level < stack.drives.size(); ++level) {
    double sum = 0;
    size_t count = 0;
    for (size_t i = level * locations; i < (level + 1) * locations; ++i) {
      if (!IsValid(stack, i)) continue;
      sum += stack.luminance[i];
      ++count;
    }
    means.push_back(count > 0 ? sum / static_cast<double>(count) : 0);
  }
  return means;
}

// The location's luminance over the field's mean, over its valid levels; 0 without any.
std::vector<double> LocationShares(const MaskedStack& stack, const std::vector<double>& means) {
  std::vector<double> shares;
  for (size_t location = 0; location < stack.LocationCount(); ++location) {
    double sum = 0;
    double expected = 0;
    for (size_t level = 0; level < means.size(); ++level) {
      const size_t place = level * stack.LocationCount() + location;
      if (!IsValid(stack, place)) continue;
      sum += stack.luminance[place];
      expected += means[level];
    }
    shares.push_back(expected > 0 ? std::max(sum / expected, 0.0) : 0);
  }
  return shares;
}

}  // namespace

absl::StatusOr<FieldWeights> RelativeFieldWeights(const MaskedStack& stack) {
  EYEBOX_RETURN_IF_ERROR(ValidateMaskedStack(stack));
  const std::vector<double> means = LevelMeans(stack);
  const std::vector<double> shares = LocationShares(stack, means);
  FieldWeights weights;
  for (const double share : shares) {
    weights.locations.push_back(share > kRelativeFloor ? 1 / (share * share) : 0);
  }
  const double floor = kRelativeFloor * *std::max_element(means.begin(), means.end());
  for (size_t level = 0; level < means.size(); ++level) {
    double squares = 0;
    size_t count = 0;
    for (size_t location = 0; location < shares.size(); ++location) {
      const size_t place = level * shares.size() + location;
      if (!IsValid(stack, place) || weights.locations[location] == 0) continue;
      const double luminance = std::max<double>(stack.luminance[place] / shares[location], floor);
      squares += luminance * luminance;
      ++count;
    }
    weights.levels.push_back(count > 0 ? static_cast<double>(count) / squares : 1);
  }
  return weights;
}

absl::StatusOr<SharedExponentFit> FitSharedExponent(const MaskedStack& stack,
                                                    const FieldWeights& weights,
                                                    const SharedExponentOptions& options) {
  EYEBOX_RETURN_IF_ERROR(ValidateMaskedStack(stack));
  EYEBOX_RETURN_IF_ERROR(ValidateWeights(stack, weights));
  EYEBOX_RETURN_IF_ERROR(ValidateGammaLimits(options.gamma_min, options.gamma_max));
  const std::vector<MaskGroup> groups = GroupByMask(stack, weights);
  SharedExponentFit fit;
  fit.distinct_masks = groups.size();
  for (const MaskGroup& group : groups) {
    fit.locations += group.members.size();
    fit.readings += group.members.size() * group.levels.size();
  }
  fit.degrees_of_freedom = static_cast<double>(fit.readings) -
                           2 * static_cast<double>(fit.locations) - (options.with_cutoff ? 2 : 1);
  if (!(fit.degrees_of_freedom > 0)) {
    return Rejected(kStack,
                    absl::StrCat(fit.locations, " locations with ", fit.readings,
                                 " valid readings leave no degree of freedom"),
                    "check the mask, or measure more levels");
  }
  const ShapeOptimum optimum = SearchShape(stack, weights, groups, options);
  EYEBOX_RETURN_IF_ERROR(CheckOptimum(optimum, options));
  fit.gamma = optimum.gamma;
  fit.cutoff_drive = optimum.cutoff_drive;
  fit.gain.assign(stack.LocationCount(), std::numeric_limits<double>::quiet_NaN());
  fit.offset = fit.rms = fit.gain;
  const Activation shape{0, 1, fit.cutoff_drive, fit.gamma};
  for (const MaskGroup& group : groups) FitMembers(stack, weights, group, shape, fit);
  SetSigmas(optimum, options.with_cutoff, fit);
  fit.termination = absl::StrCat("steps no longer move the exponent, after ", optimum.iterations,
                                 " over ", groups.size(), " masks");
  if (options.with_cutoff && fit.cutoff_drive == 0)
    fit.termination += "; cutoff_drive at its bound 0";
  return fit;
}

}  // namespace eyebox::fit
