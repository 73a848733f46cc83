#include "optics/reduce/match_dark.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "capture/base/status.h"

namespace eyebox::optics {
namespace {

constexpr double kSteepestDoublingK = 5;
constexpr double kNegligible = 0.05;  // of the temporal dark noise of a frame
constexpr double kLargestClippedShare = 0.01;

using Dark = std::shared_ptr<const DarkFrame>;

double TemporalNoiseDn(const NoiseModel& noise) {
  return std::sqrt(noise.read_variance_dn2 + noise.quantisation_variance_dn2);
}

double DarkCurrentDn(const DarkFrame& dark, const NoiseModel& noise) {
  if (dark.dark_current_dn) return *dark.dark_current_dn;
  return noise.gain_dn_per_e > 0 ? noise.read_variance_dn2 / noise.gain_dn_per_e
                                 : TemporalNoiseDn(noise);
}

std::optional<double> MeanDn(const DarkFrame& dark, const Image<uint8_t>& defective) {
  double sum = 0;
  size_t count = 0;
  const auto mask = dark.image_dn.mask.pixels();
  for (size_t i = 0; i < mask.size(); ++i) {
    if (mask[i] != 0 || defective.pixels()[i] != 0) continue;
    sum += dark.image_dn.value.pixels()[i];
    ++count;
  }
  if (count == 0 || dark.clipped_share > kLargestClippedShare) return std::nullopt;
  return sum / static_cast<double>(count);
}

// A borrowed dark: the calibration outlives every bracket that is ordered with it.
Dark Borrowed(const DarkFrame& dark) { return {Dark(), &dark}; }

Dark WithThermalSigma(DarkFrame dark, const std::string& source, double temperature_deg_c,
                      double error_dn) {
  const auto variance_dn2 = static_cast<float>(error_dn * error_dn);
  for (float& variance : dark.image_dn.variance.pixels()) variance += variance_dn2;
  dark.image_dn.history.push_back(
      absl::StrFormat("MatchDark(%s for a light of %.4g degC, thermal sigma %.2g DN)", source,
                      temperature_deg_c, error_dn));
  return std::make_shared<const DarkFrame>(std::move(dark));
}

// Linear in temperature between two darks of one setting.
DarkFrame Between(const DarkFrame& cold, const DarkFrame& hot, double temperature_deg_c) {
  const double span = *hot.temperature_degC - *cold.temperature_degC;
  const auto of_hot = static_cast<float>((temperature_deg_c - *cold.temperature_degC) / span);
  const float of_cold = 1 - of_hot;
  DarkFrame mean{cold.setting, UnwrittenMeasuredImage(cold.image_dn.size(), "DN")};
  const MeasuredImage& a = cold.image_dn;
  const MeasuredImage& b = hot.image_dn;
  for (size_t i = 0; i < a.mask.pixels().size(); ++i) {
    mean.image_dn.value.pixels()[i] = of_cold * a.value.pixels()[i] + of_hot * b.value.pixels()[i];
    mean.image_dn.variance.pixels()[i] =
        of_cold * of_cold * a.variance.pixels()[i] + of_hot * of_hot * b.variance.pixels()[i];
    mean.image_dn.mask.pixels()[i] = static_cast<uint8_t>(a.mask.pixels()[i] | b.mask.pixels()[i]);
  }
  BlankMaskedPixels(mean.image_dn);
  mean.image_dn.history = a.history;
  mean.temperature_degC = temperature_deg_c;
  mean.clipped_share = std::max(cold.clipped_share, hot.clipped_share);
  return mean;
}

// An exponential lies below its chord by at most an eighth of its rise times the logarithm of the
// ratio of its ends.
double ChordErrorDn(const DarkFrame& cold, const DarkFrame& hot, const NoiseModel& noise) {
  const double span = *hot.temperature_degC - *cold.temperature_degC;
  return DarkCurrentDn(hot, noise) * std::numbers::ln2 * span / kSteepestDoublingK / 8;
}

struct Candidates {
  const DarkFrame* nearest = nullptr;
  const DarkFrame* cold = nullptr;  // the two that enclose the temperature; null where none does
  const DarkFrame* hot = nullptr;
};

Candidates Choose(const std::vector<const DarkFrame*>& darks, double temperature_deg_c) {
  Candidates chosen;
  const auto distance = [temperature_deg_c](const DarkFrame* dark) {
    return std::abs(*dark->temperature_degC - temperature_deg_c);
  };
  for (const DarkFrame* dark : darks) {
    if (chosen.nearest == nullptr || distance(dark) < distance(chosen.nearest)) {
      chosen.nearest = dark;
    }
    const DarkFrame*& side =
        *dark->temperature_degC <= temperature_deg_c ? chosen.cold : chosen.hot;
    if (side == nullptr || distance(dark) < distance(side)) side = dark;
  }
  return chosen;
}

absl::Status TooFar(const Setting& setting, const std::string& what, double error_dn,
                    const NoiseModel& noise) {
  return Rejected(
      absl::StrCat("light of ", Describe(setting)),
      absl::StrFormat("%s, which may differ by %.2g DN of dark current; a frame's own noise is "
                      "%.2g DN",
                      what, error_dn, TemporalNoiseDn(noise)),
      "record darks between the lights, or let the camera warm up first");
}

absl::StatusOr<Dark> DarkForUnknown(const std::vector<const DarkFrame*>& darks,
                                    const Setting& setting, const NoiseModel& noise) {
  for (const DarkFrame* dark : darks) {
    const double error_dn = ThermalErrorDn(*darks[0], *dark->temperature_degC, noise);
    if (error_dn <= TemporalNoiseDn(noise)) continue;
    return TooFar(setting,
                  absl::StrFormat("it tells no temperature, and there are darks of %.4g and %.4g "
                                  "degC",
                                  *darks[0]->temperature_degC, *dark->temperature_degC),
                  error_dn, noise);
  }
  return Borrowed(*darks[0]);
}

}  // namespace

void StateDarkCurrents(Calibration& calibration) {
  std::vector<DarkFrame>& darks = calibration.darks;
  std::vector<std::optional<double>> means;
  for (const DarkFrame& dark : darks) means.push_back(MeanDn(dark, calibration.defects.defective));
  const auto [shortest, longest] = std::ranges::minmax_element(
      darks, {}, [](const DarkFrame& dark) { return dark.setting.exposure_s; });
  if (darks.empty() || SameSetting(shortest->setting, longest->setting)) return;
  double rate_dn_s = 0;
  for (size_t i = 0; i < darks.size(); ++i) {
    for (size_t k = 0; k < darks.size(); ++k) {
      if (!SameSetting(darks[i].setting, shortest->setting) ||
          !SameSetting(darks[k].setting, longest->setting)) {
        continue;
      }
      if (!means[i] || !means[k]) return;
      rate_dn_s = std::max(rate_dn_s, (*means[k] - *means[i]) / (longest->setting.exposure_s -
                                                                 shortest->setting.exposure_s));
    }
  }
  for (DarkFrame& dark : darks) dark.dark_current_dn = rate_dn_s * dark.setting.exposure_s;
}

double ThermalErrorDn(const DarkFrame& dark, double temperature_deg_c, const NoiseModel& noise) {
  if (!dark.temperature_degC) return 0;
  const double difference = temperature_deg_c - *dark.temperature_degC;
  return DarkCurrentDn(dark, noise) * std::abs(std::exp2(difference / kSteepestDoublingK) - 1);
}

absl::StatusOr<Dark> DarkFor(const Calibration& calibration, const Setting& setting,
                             std::optional<double> temperature_deg_c) {
  EYEBOX_ASSIGN_OR_RETURN(const DarkFrame* const first, FindDark(calibration, setting));
  std::vector<const DarkFrame*> darks;
  for (const DarkFrame& dark : calibration.darks) {
    if (!SameSetting(dark.setting, setting)) continue;
    if (!dark.temperature_degC) return Borrowed(*first);
    darks.push_back(&dark);
  }
  const NoiseModel& noise = calibration.noise;
  if (!temperature_deg_c) return DarkForUnknown(darks, setting, noise);
  const auto [nearest, cold, hot] = Choose(darks, *temperature_deg_c);
  const double error_dn = ThermalErrorDn(*nearest, *temperature_deg_c, noise);
  if (error_dn <= kNegligible * TemporalNoiseDn(noise)) return Borrowed(*nearest);
  const bool enclosed =
      cold != nullptr && hot != nullptr && cold->image_dn.size() == hot->image_dn.size();
  const double chord_error_dn = enclosed ? ChordErrorDn(*cold, *hot, noise) : error_dn;
  if (std::min(chord_error_dn, error_dn) > TemporalNoiseDn(noise)) {
    return TooFar(setting,
                  absl::StrFormat("it was taken at %.4g degC, the nearest dark at %.4g degC",
                                  *temperature_deg_c, *nearest->temperature_degC),
                  error_dn, noise);
  }
  if (chord_error_dn < error_dn) {
    return WithThermalSigma(Between(*cold, *hot, *temperature_deg_c),
                            absl::StrFormat("darks of %.4g and %.4g degC", *cold->temperature_degC,
                                            *hot->temperature_degC),
                            *temperature_deg_c, chord_error_dn);
  }
  return WithThermalSigma(*nearest,
                          absl::StrFormat("dark of %.4g degC", *nearest->temperature_degC),
                          *temperature_deg_c, error_dn);
}

}  // namespace eyebox::optics
