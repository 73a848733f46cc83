#include "optics/sensor/emva1288/evaluate.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "absl/strings/str_cat.h"
#include "capture/base/status.h"
#include "optics/sensor/emva1288/dark_current.h"
#include "optics/sensor/emva1288/photon_transfer_steps.h"

namespace eyebox::optics {
namespace {

using Steps = std::vector<PhotonTransferStep>;

constexpr double kQuantisationDn2 = 1.0 / 12;
constexpr double kLeastDarkVarianceDn2 = 0.24;  // below, quantisation hides the noise
constexpr size_t kStepsAskedFor = 50;
constexpr size_t kFewestLinearSteps = 3;
constexpr double kHalfFrom = 0.4;  // of saturation: what passes for "50 %"
constexpr double kHalfTo = 0.6;
constexpr double kPlateauGrowth = 0.1;  // of what a linear sensor would grow by

double Relative(const Quantity& q) { return q.value != 0 ? q.sigma / q.value : 0; }

Quantity Quotient(const Quantity& a, const Quantity& b) {
  const double value = a.value / b.value;
  return {value, std::hypot(a.sigma / b.value, value * Relative(b))};
}

// The root of a variance; one that does not differ from 0 gets the root of its sigma as sigma.
Quantity Root(double variance, double sigma) {
  const double root = std::sqrt(std::max(variance, 0.0));
  return {root, variance > sigma ? sigma / (2 * root) : std::sqrt(sigma)};
}

double DarkVarianceSigma(const OrderedSets& sets) {
  return sets.temporal_dark.front()->temporal_variance_sigma_dn2;
}

absl::Status FitGain(const OrderedSets& sets, const Steps& steps, double upper_dn,
                     Emva1288Result& result) {
  std::vector<LinePoint> variances;
  std::vector<LinePoint> signals;
  for (const PhotonTransferStep& step : steps) {
    if (step.signal_dn > upper_dn) continue;
    variances.push_back({step.signal_dn, step.excess_variance_dn2, step.variance_sigma_dn2});
    signals.push_back({step.irradiation, step.signal_dn, step.signal_sigma_dn});
  }
  const auto gain = FitThroughOrigin(variances, DarkVarianceSigma(sets));
  const auto responsivity = FitThroughOrigin(signals);
  if (!gain || !responsivity || !(gain->value > 0) || !(responsivity->value > 0)) {
    return Rejected("series", "noise or signal do not grow with the light below 70 % of saturation",
                    "record raw images: no gamma, no automatic exposure, light that is constant");
  }
  result.gain_dn_per_e = *gain;
  result.responsivity_dn = *responsivity;
  return absl::OkStatus();
}

void MeasureDarkNoise(const OrderedSets& sets, Emva1288Result& result) {
  const SetStatistics& shortest = *sets.temporal_dark.front();
  result.dark_mean_dn = {shortest.mean_dn, shortest.mean_sigma_dn};
  Quantity variance{shortest.temporal_variance_dn2, shortest.temporal_variance_sigma_dn2};
  if (const auto at_zero = DarkVarianceAtZero(sets.temporal_dark)) variance = *at_zero;
  if (variance.value < kLeastDarkVarianceDn2) {
    result.dark_noise_is_quantisation = true;
    result.warnings.push_back(
        "the temporal dark noise is below that of quantisation: the standard's upper limit of 0.49 "
        "DN stands in for it");
    variance.value = kLeastDarkVarianceDn2;
  }
  result.dark_noise_dn = Root(variance.value, variance.sigma);
  result.dark_noise_e =
      Quotient(Root(variance.value - kQuantisationDn2, variance.sigma), result.gain_dn_per_e);
}

void FindSaturation(const Steps& steps, size_t at, Emva1288Result& result) {
  const double top = steps[at].irradiation;
  const double above = at + 1 < steps.size() ? steps[at + 1].irradiation : top;
  const double below = at > 0 ? steps[at - 1].irradiation : top;
  result.saturation_reached = at + 1 < steps.size();
  // Anywhere within half a step to either side.
  result.saturation_irradiation = {top, (above - below) / 4 / std::sqrt(3.0)};
  result.saturation_e =
      Quotient({result.responsivity_dn.value * top,
                result.responsivity_dn.value * result.saturation_irradiation.sigma},
               result.gain_dn_per_e);
  if (!result.saturation_reached) {
    result.warnings.push_back(
        "the noise still rises at the brightest step: saturation, dynamic range and maximum SNR "
        "are lower bounds");
    return;
  }
  const PhotonTransferStep& last = steps.back();
  const PhotonTransferStep& previous = steps[steps.size() - 2];
  const double linear_growth = last.irradiation / previous.irradiation - 1;
  const double growth = last.signal_dn / previous.signal_dn - 1;
  if (linear_growth > 0 && growth < kPlateauGrowth * linear_growth) {
    result.plateau_e = Quotient({last.signal_dn, last.signal_sigma_dn}, result.gain_dn_per_e);
  }
}

void DeriveRange(const Emva1288Options& options, Emva1288Result& result) {
  const Quantity& gain = result.gain_dn_per_e;
  const Quantity dark_e = Quotient(result.dark_noise_dn, gain);
  const double root = std::sqrt(dark_e.value * dark_e.value + 0.25);
  result.threshold_e = {root + 0.5, dark_e.sigma * dark_e.value / root};
  result.dynamic_range = Quotient(result.saturation_e, result.threshold_e);
  const double snr = std::sqrt(result.saturation_e.value);
  result.snr_max = {snr, 0.5 * snr * Relative(result.saturation_e)};
  if (options.photons_known) {
    result.quantum_efficiency = Quotient(result.responsivity_dn, gain);
    result.threshold_photons = Quotient(result.threshold_e, *result.quantum_efficiency);
  }
}

// The group with most steps from `from_dn` to `to_dn`, the first of equals.
int LinearityGroup(const Steps& steps, double from_dn, double to_dn) {
  std::map<int, int> counts;
  for (const PhotonTransferStep& step : steps) {
    if (step.signal_dn >= from_dn && step.signal_dn <= to_dn) ++counts[step.group];
  }
  const auto most = std::max_element(counts.begin(), counts.end(),
                                     [](auto& a, auto& b) { return a.second < b.second; });
  return most == counts.end() ? 0 : most->first;
}

void MeasureLinearity(const Emva1288Options& options, double saturation_dn, Steps& steps,
                      Emva1288Result& result) {
  std::vector<LinePoint> points;
  std::vector<PhotonTransferStep*> taken;
  LinearityError error;
  const double from_dn = options.linearity_from * saturation_dn;
  const double to_dn = options.linearity_to * saturation_dn;
  const int group = LinearityGroup(steps, from_dn, to_dn);
  for (PhotonTransferStep& step : steps) {
    if (step.group != group || step.signal_dn < from_dn || step.signal_dn > to_dn) continue;
    points.push_back({step.irradiation, step.signal_dn, step.signal_sigma_dn});
    taken.push_back(&step);
    error.sigma = std::max(error.sigma, step.signal_sigma_dn / step.signal_dn);
  }
  const auto line = FitRelativeLine(points);
  if (!line || points.size() < kFewestLinearSteps) {
    result.warnings.push_back("fewer than three steps from 5 to 95 % of saturation: no linearity");
    return;
  }
  for (PhotonTransferStep* step : taken) {
    const double predicted = line->slope.value * step->irradiation + line->offset.value;
    step->linearity_deviation = step->signal_dn / predicted - 1;
    error.mean_absolute += std::abs(step->linearity_deviation) / static_cast<double>(points.size());
    error.minimum = std::min(error.minimum, step->linearity_deviation);
    error.maximum = std::max(error.maximum, step->linearity_deviation);
  }
  error.steps = static_cast<int>(points.size());
  result.linearity = error;
}

// The bright spatial set nearest to half of saturation, of those that do not clip.
const SetStatistics* HalfBright(const OrderedSets& sets, double half_dn) {
  const SetStatistics* best = nullptr;
  const auto distance = [&](const SetStatistics& set) {
    const SetStatistics* dark = DarkOf(sets.spatial_dark, set.condition.exposure_s);
    return dark == nullptr ? std::numeric_limits<double>::infinity()
                           : std::abs(set.mean_dn - dark->mean_dn - half_dn);
  };
  for (const SetStatistics* set : sets.spatial_bright) {
    if (std::isfinite(distance(*set)) && (best == nullptr || distance(*set) < distance(*best))) {
      best = set;
    }
  }
  return best;
}

absl::Status MeasureNonuniformity(const OrderedSets& sets, double saturation_dn,
                                  Emva1288Result& result) {
  const SetStatistics* bright = HalfBright(sets, 0.5 * saturation_dn);
  if (bright == nullptr) {
    return BadInput("series", "no bright and dark stack share an exposure: no PRNU1288",
                    "record a stack at half of saturation and a dark stack of its exposure");
  }
  const SetStatistics& dark = *DarkOf(sets.spatial_dark, bright->condition.exposure_s);
  const double signal_dn = bright->mean_dn - dark.mean_dn;
  const double level = signal_dn / saturation_dn;
  if (level < kHalfFrom || level > kHalfTo) {
    result.warnings.push_back(absl::StrCat(bright->condition.where, ": PRNU1288 was measured at ",
                                           static_cast<int>(std::lround(100 * level)),
                                           " % of saturation, the standard asks for 50 %"));
  }
  result.dsnu_e = Quotient(Root(dark.spatial_variance_dn2, dark.spatial_variance_sigma_dn2),
                           result.gain_dn_per_e);
  const auto prnu_of = [signal_dn](double bright_variance, double bright_sigma,
                                   double dark_variance, double dark_sigma) {
    const Quantity root =
        Root(bright_variance - dark_variance, std::hypot(bright_sigma, dark_sigma));
    return Quantity{root.value / signal_dn, root.sigma / signal_dn};
  };
  result.prnu = prnu_of(bright->highpass_variance_dn2, bright->highpass_variance_sigma_dn2,
                        dark.highpass_variance_dn2, dark.highpass_variance_sigma_dn2);
  result.prnu_unfiltered = prnu_of(bright->spatial_variance_dn2, bright->spatial_variance_sigma_dn2,
                                   dark.spatial_variance_dn2, dark.spatial_variance_sigma_dn2);
  return absl::OkStatus();
}

}  // namespace

double Emva1288Result::DynamicRangeDb() const { return 20 * std::log10(dynamic_range.value); }
double Emva1288Result::SnrMaxDb() const { return 20 * std::log10(snr_max.value); }

absl::StatusOr<Emva1288Result> EvaluateEmva1288(std::span<const SetStatistics> sets,
                                                const Emva1288Options& options) {
  const OrderedSets ordered = OrderSets(sets, options.pairs_are_temporal);
  EYEBOX_ASSIGN_OR_RETURN(Steps steps, SubtractDarks(ordered));
  const size_t saturation = SaturationStep(steps);
  const double saturation_dn = steps[saturation].signal_dn;
  Emva1288Result result;
  EYEBOX_RETURN_IF_ERROR(FitGain(ordered, steps, options.gain_fraction * saturation_dn, result));
  MeasureDarkNoise(ordered, result);
  FindSaturation(steps, saturation, result);
  DeriveRange(options, result);
  MeasureLinearity(options, saturation_dn, steps, result);
  EYEBOX_RETURN_IF_ERROR(MeasureNonuniformity(ordered, saturation_dn, result));
  result.dark_current = MeasureDarkCurrent(ordered.temporal_dark, result.gain_dn_per_e);
  if (steps.size() < kStepsAskedFor) {
    result.warnings.push_back(
        absl::StrCat("the series has ", steps.size(), " bright steps, the standard asks for 50"));
  }
  result.steps = std::move(steps);
  return result;
}

}  // namespace eyebox::optics
