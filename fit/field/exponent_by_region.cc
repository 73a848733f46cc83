#include "fit/field/exponent_by_region.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "capture/base/status.h"
#include "fit/field/f_distribution.h"

namespace eyebox::fit {
namespace {

struct Part {
  std::vector<float> luminance;
  std::vector<uint8_t> valid;
  FieldWeights weights;
};

Part PartOf(const MaskedStack& stack, const FieldWeights& weights,
            const std::vector<size_t>& members) {
  Part part;
  part.weights.levels = weights.levels;
  for (const size_t location : members) {
    part.weights.locations.push_back(weights.locations[location]);
  }
  for (size_t level = 0; level < stack.drives.size(); ++level) {
    for (const size_t location : members) {
      const size_t place = level * stack.LocationCount() + location;
      part.luminance.push_back(stack.luminance[place]);
      part.valid.push_back(stack.valid.empty() ? 1 : stack.valid[place]);
    }
  }
  return part;
}

std::map<int, std::vector<size_t>> MembersOf(std::span<const int> region_of) {
  std::map<int, std::vector<size_t>> members;
  for (size_t location = 0; location < region_of.size(); ++location) {
    if (region_of[location] >= 0) members[region_of[location]].push_back(location);
  }
  return members;
}

void Judge(bool with_cutoff, RegionComparison& comparison) {
  double squares = 0;
  for (const RegionExponent& region : comparison.regions) {
    squares += region.fit.weighted_sum_of_squares;
    comparison.denominator_freedom += region.fit.degrees_of_freedom;
  }
  const auto extra = static_cast<double>(comparison.regions.size() - 1);
  comparison.numerator_freedom = (with_cutoff ? 2 : 1) * extra;
  const double saved = std::max(comparison.common.weighted_sum_of_squares - squares, 0.0);
  comparison.f = saved / comparison.numerator_freedom / (squares / comparison.denominator_freedom);
  comparison.p_value =
      FTail(comparison.f, comparison.numerator_freedom, comparison.denominator_freedom);
  const auto readings = static_cast<double>(comparison.common.readings);
  comparison.delta_bic =
      comparison.numerator_freedom * std::log(readings) - readings * std::log1p(saved / squares);
  const bool chance = comparison.p_value >= kSignificance;
  comparison.one_serves = chance || comparison.delta_bic > 0;
  comparison.reason = absl::StrFormat(
      "%s: F(%.0f, %.0f) = %.3f, p = %.3g, delta-BIC %.1f %s one exponent",
      comparison.one_serves ? "one exponent serves the field"
                            : "the exponent varies over the field",
      comparison.numerator_freedom, comparison.denominator_freedom, comparison.f,
      comparison.p_value, comparison.delta_bic, comparison.delta_bic > 0 ? "for" : "against");
  if (!chance && comparison.one_serves) {
    comparison.reason += "; the differences between regions are real but too small to pay";
  }
}

}  // namespace

absl::StatusOr<RegionComparison> CompareRegions(const MaskedStack& stack,
                                                const FieldWeights& weights,
                                                std::span<const int> region_of,
                                                const SharedExponentOptions& options) {
  if (region_of.size() != stack.LocationCount()) {
    return BadInput("regions",
                    absl::StrCat("there are ", region_of.size(), " places for ",
                                 stack.LocationCount(), " locations"),
                    "give one region per location");
  }
  const std::map<int, std::vector<size_t>> members = MembersOf(region_of);
  if (members.size() < 2) {
    return Rejected("regions", absl::StrCat("the field has ", members.size()),
                    "part it into 2 regions at least");
  }
  FieldWeights within = weights;
  for (size_t i = 0; i < std::min(region_of.size(), within.locations.size()); ++i) {
    if (region_of[i] < 0) within.locations[i] = 0;
  }
  RegionComparison comparison;
  EYEBOX_ASSIGN_OR_RETURN(comparison.common, FitSharedExponent(stack, within, options));
  for (const auto& [region, locations] : members) {
    const Part part = PartOf(stack, weights, locations);
    auto fit = FitSharedExponent({stack.drives, part.luminance, part.valid}, part.weights, options);
    if (!fit.ok()) {
      return absl::Status(fit.status().code(), absl::StrCat("region ", region, ": ",
                                                            std::string(fit.status().message())));
    }
    comparison.regions.push_back({region, *std::move(fit)});
  }
  Judge(options.with_cutoff, comparison);
  return comparison;
}

}  // namespace eyebox::fit
