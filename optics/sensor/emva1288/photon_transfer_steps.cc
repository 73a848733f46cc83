#include "optics/sensor/emva1288/photon_transfer_steps.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "absl/strings/str_cat.h"
#include "capture/base/status.h"

namespace eyebox::optics {
namespace {

constexpr size_t kFewestSteps = 3;

// Pairs make the temporal series, stacks the spatial one; either serves as both if alone.
void Split(const std::vector<const SetStatistics*>& all,
           std::vector<const SetStatistics*>& temporal,
           std::vector<const SetStatistics*>& spatial) {
  for (const SetStatistics* set : all) (set->images == 2 ? temporal : spatial).push_back(set);
  if (temporal.empty()) temporal = spatial;
  if (spatial.empty()) spatial = temporal;
}

}  // namespace

OrderedSets OrderSets(std::span<const SetStatistics> sets, bool pairs_are_temporal) {
  std::vector<const SetStatistics*> bright;
  std::vector<const SetStatistics*> dark;
  for (const SetStatistics& set : sets) (set.condition.dark ? dark : bright).push_back(&set);
  std::stable_sort(bright.begin(), bright.end(), [](const auto* a, const auto* b) {
    return a->condition.irradiation < b->condition.irradiation;
  });
  std::stable_sort(dark.begin(), dark.end(), [](const auto* a, const auto* b) {
    return a->condition.exposure_s < b->condition.exposure_s;
  });
  if (!pairs_are_temporal) return {bright, dark, bright, dark};
  OrderedSets ordered;
  Split(bright, ordered.temporal_bright, ordered.spatial_bright);
  Split(dark, ordered.temporal_dark, ordered.spatial_dark);
  return ordered;
}

const SetStatistics* DarkOf(std::span<const SetStatistics* const> darks, double exposure_s) {
  for (const SetStatistics* dark : darks) {
    if (SameSetting({dark->condition.exposure_s, 0}, {exposure_s, 0})) return dark;
  }
  return nullptr;
}

absl::StatusOr<std::vector<PhotonTransferStep>> SubtractDarks(const OrderedSets& sets) {
  std::vector<PhotonTransferStep> steps;
  for (const SetStatistics* set : sets.temporal_bright) {
    const double exposure_s = set->condition.exposure_s;
    const SetStatistics* dark = DarkOf(sets.temporal_dark, exposure_s);
    if (dark == nullptr) dark = DarkOf(sets.spatial_dark, exposure_s);
    if (dark == nullptr) {
      return BadInput(set->condition.where,
                      absl::StrCat("no dark set has the exposure ", exposure_s, " s"),
                      "record a dark of every exposure that a bright set uses");
    }
    PhotonTransferStep step;
    step.exposure_s = exposure_s;
    step.irradiation = set->condition.irradiation;
    step.group = set->condition.group;
    step.signal_dn = set->mean_dn - dark->mean_dn;
    step.signal_sigma_dn = std::hypot(set->mean_sigma_dn, dark->mean_sigma_dn);
    step.dark_mean_dn = dark->mean_dn;
    step.variance_dn2 = set->temporal_variance_dn2;
    step.excess_variance_dn2 = set->temporal_variance_dn2 - dark->temporal_variance_dn2;
    step.variance_sigma_dn2 = set->temporal_variance_sigma_dn2;
    step.saturated_share = set->saturated_share;
    step.linearity_deviation = std::numeric_limits<double>::quiet_NaN();
    steps.push_back(step);
  }
  if (steps.size() < kFewestSteps) {
    return Rejected("series", absl::StrCat("it has ", steps.size(), " bright steps"),
                    "record at least three irradiations, better fifty, from dark to saturation");
  }
  return steps;
}

size_t SaturationStep(std::span<const PhotonTransferStep> steps) {
  size_t best = steps.size() - 1;
  int below = 0;
  for (size_t i = steps.size(); i-- > 0 && below < 2;) {
    if (steps[i].variance_dn2 >= steps[best].variance_dn2) {
      best = i;
      below = 0;
    } else {
      ++below;
    }
  }
  return best;
}

}  // namespace eyebox::optics
