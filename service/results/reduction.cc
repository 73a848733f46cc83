#include "service/results/reduction.h"

#include <cmath>
#include <cstdio>
#include <utility>

#include "capture/base/status.h"
#include "optics/reduce/variance_budget.h"
#include "service/artifacts.h"
#include "service/results/parameter.h"
#include "service/results/sigma_map.h"
#include "service/steps/reference_disk.h"

namespace eyebox::service {
namespace {

// A linear sensor's pairs agree with 1; beyond this the luminance scale depends on the exposure.
constexpr double kNotedNonlinearity = 0.01;
constexpr double kNearlyAll = 0.9;  // of the pixels

Image<float> MaskAsFloat(const optics::MeasuredImage& image) {
  Image<float> mask(image.size());
  for (size_t i = 0; i < mask.pixels().size(); ++i) mask.pixels()[i] = image.mask.pixels()[i];
  return mask;
}

// First order where the variance is known, else what one sigma of it would be the root of.
double SigmaOfRoot(double variance, double sigma) {
  const double root = std::sqrt(variance);
  return variance > sigma ? sigma / (2 * root) : std::sqrt(variance + sigma) - root;
}

void AddMean(const optics::LuminanceImage& luminance, v1::ReduceResult& result) {
  const optics::MeasuredImage& image = luminance.image;
  double sum = 0;
  double scatter_sum = 0;
  double scatter_squares = 0;
  double variance_sum = 0;
  int valid = 0;
  for (size_t i = 0; i < image.mask.pixels().size(); ++i) {
    if (image.mask.pixels()[i] != 0) continue;
    sum += image.value.pixels()[i];
    variance_sum += image.variance.pixels()[i];
    const double scatter = luminance.ScatterSigma(i);
    scatter_sum += scatter;
    scatter_squares += scatter * scatter;
    ++valid;
  }
  result.set_valid_pixels(valid);
  result.set_invalid_pixels(static_cast<int32_t>(image.mask.pixels().size()) - valid);
  if (valid == 0) return;
  AddParameter(*result.mutable_parameters(), "mean", sum / valid,
               std::hypot(std::sqrt(variance_sum), scatter_sum) / valid, image.unit);
  AddParameter(*result.mutable_parameters(), "pixel_sigma_rms",
               std::sqrt((variance_sum + scatter_squares) / valid), 0, image.unit);
}

// Mean over the disk at the image centre that levels are read from; one without a value there
// has none.
void AddCentre(const optics::LuminanceImage& luminance, const optics::Calibration& calibration,
               v1::ReduceResult& result) {
  const DiskReading disk = ReadReferenceDisk(luminance, calibration, 0);
  double sum = 0;
  double variance = 0;
  double scatter = 0;
  int count = 0;
  for (size_t i = 0; i < disk.luminance.size(); ++i) {
    if (!std::isfinite(disk.luminance[i])) continue;
    sum += disk.luminance[i];
    scatter += disk.scatter_sigma[i];
    variance += disk.own_variance[i] + disk.flat_variance[i];
    ++count;
  }
  if (count == 0) return;
  AddParameter(*result.mutable_parameters(), "at_centre", sum / count,
               std::hypot(std::sqrt(variance), scatter) / count, luminance.image.unit);
}

void AddExposures(const optics::BracketReport& report, v1::ReduceResult& result) {
  for (const optics::ExposureShare& share : report.exposures) {
    v1::ExposureShare& exposure = *result.add_exposures();
    exposure.set_exposure_s(share.exposure_s);
    exposure.set_frames(share.frames);
    exposure.set_saturated_share(share.saturated);
  }
  for (const optics::ExposurePairCheck& check : report.pairs) {
    v1::ExposurePair& pair = *result.add_exposure_pairs();
    pair.set_short_exposure_s(check.shorter_s);
    pair.set_long_exposure_s(check.longer_s);
    pair.set_pixels(static_cast<int32_t>(check.pixels));
    if (!std::isfinite(check.ratio)) continue;
    pair.set_signal_ratio_over_time_ratio(check.ratio);
    pair.set_sigma(check.sigma);
  }
}

// Each term's part of the pixels' variance; what all pixels share beside it.
void AddBudget(const optics::ReducedLevel& level, v1::ReduceResult& result) {
  const optics::VarianceBudget budget = optics::WithScale(
      level.report.budget, level.luminance.image, level.luminance.scale_relative_sigma);
  const std::pair<const char*, double> terms[] = {
      {"variance_photon", budget.photon},
      {"variance_read", budget.read},
      {"variance_quantisation", budget.quantisation},
      {"variance_dark", budget.dark},
      {"variance_flat", budget.flat},
      {"variance_linearity", budget.linearity},
      {"variance_scatter", budget.scatter},
      {"variance_scatter_common", budget.scatter_common},
      {"variance_scale_common", budget.scale}};
  for (const auto& [name, share] : terms) {
    AddParameter(*result.mutable_parameters(), name, share, 0, "1");
  }
}

// A longer exposure that saturates nearly everywhere has nothing to say, and need not.
bool IsSaturated(const optics::BracketReport& report, double exposure_s) {
  for (const optics::ExposureShare& share : report.exposures) {
    if (share.exposure_s == exposure_s) return share.saturated > kNearlyAll;
  }
  return false;
}

void AddPairWarnings(const optics::BracketReport& report, v1::ReduceResult& result) {
  for (const optics::ExposurePairCheck& check : report.pairs) {
    char text[200];
    if (!std::isfinite(check.ratio)) {
      if (IsSaturated(report, check.longer_s)) continue;
      std::snprintf(text, sizeof(text),
                    "exposures %g s and %g s have no signal in common; choose them closer together",
                    check.shorter_s, check.longer_s);
      result.add_warnings(text);
      continue;
    }
    const double departure = std::abs(check.ratio - 1);
    if (departure < kNotedNonlinearity || departure < 3 * check.sigma) continue;
    std::snprintf(text, sizeof(text),
                  "between %g s and %g s the signal grows %+.1f %% against the time: the sensor is "
                  "not linear there, or the light changed",
                  check.shorter_s, check.longer_s, 100 * (check.ratio - 1));
    result.add_warnings(text);
  }
}

absl::Status AddMaps(const optics::LuminanceImage& luminance, const std::filesystem::path& folder,
                     v1::ReduceResult& result) {
  const optics::MeasuredImage& image = luminance.image;
  EYEBOX_ASSIGN_OR_RETURN(*result.add_maps(),
                          WriteMap(folder, "luminance.npy", "luminance", image.unit, image.value));
  EYEBOX_ASSIGN_OR_RETURN(*result.add_maps(),
                          WriteMap(folder, "luminance_sigma.npy", "luminance_sigma", image.unit,
                                   SigmaMap(VarianceWithScatter(luminance))));
  if (!luminance.scatter_sigma.empty()) {
    EYEBOX_ASSIGN_OR_RETURN(*result.add_maps(), WriteMap(folder, "luminance_scatter_sigma.npy",
                                                         "luminance_scatter_sigma", image.unit,
                                                         luminance.scatter_sigma));
  }
  EYEBOX_ASSIGN_OR_RETURN(*result.add_maps(),
                          WriteMap(folder, "mask.npy", "mask", "1", MaskAsFloat(image)));
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<v1::ReduceResult> DescribeReduction(const optics::ReducedLevel& level,
                                                   const optics::Calibration& calibration,
                                                   const std::string& series,
                                                   const std::filesystem::path& folder) {
  const optics::LuminanceImage& luminance = level.luminance;
  const optics::NoiseModel& noise = calibration.noise;
  v1::ReduceResult result;
  result.set_series(series);
  result.set_unit(luminance.image.unit);
  result.set_width_px(luminance.image.size().width_px);
  result.set_height_px(luminance.image.size().height_px);
  AddMean(luminance, result);
  AddCentre(luminance, calibration, result);
  auto& parameters = *result.mutable_parameters();
  AddParameter(parameters, "system_gain", noise.gain_dn_per_e, noise.gain_sigma_dn_per_e, "DN/e-");
  AddParameter(parameters, "temporal_dark_noise", std::sqrt(noise.read_variance_dn2),
               SigmaOfRoot(noise.read_variance_dn2, noise.read_variance_sigma_dn2), "DN");
  AddParameter(parameters, "luminance_scale_relative_sigma", luminance.scale_relative_sigma, 0,
               "1");
  AddBudget(level, result);
  result.set_noise_source(noise.noise_source);
  result.set_saturated_in_all_share(level.report.all_saturated_share);
  result.set_dark_in_all_share(level.report.all_dark_share);
  result.set_hot_share(level.report.hot_share);
  AddExposures(level.report, result);
  AddPairWarnings(level.report, result);
  if (!luminance.absolute) {
    result.add_warnings("no known luminance was recorded: the values are relative");
  }
  if (!luminance.flat_corrected) {
    result.add_warnings("no flat was recorded: vignetting and pixel response are still in");
  }
  AddAll(*result.mutable_history(), luminance.image.history);
  EYEBOX_RETURN_IF_ERROR(AddMaps(luminance, folder, result));
  return result;
}

}  // namespace eyebox::service
