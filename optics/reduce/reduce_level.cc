#include "optics/reduce/reduce_level.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "capture/base/status.h"
#include "optics/photometry/scale_luminance.h"
#include "optics/reduce/compare_exposures.h"
#include "optics/reduce/divide_by_flat.h"
#include "optics/reduce/expected_rate.h"
#include "optics/reduce/merge_bracket.h"
#include "optics/reduce/order_bracket.h"
#include "optics/reduce/variance_budget.h"

namespace eyebox::optics {
namespace {

double Share(size_t part, size_t whole) {
  return static_cast<double>(part) / static_cast<double>(whole);
}

ExposureShare ShareOf(const Exposure& exposure, const MeasuredImage& rate) {
  const auto clipped = exposure.light->saturated_count.pixels();
  const size_t pixels = clipped.size();
  const size_t unsaturated =
      static_cast<size_t>(std::count(clipped.begin(), clipped.end(), uint8_t{0}));
  ExposureShare share;
  share.exposure_s = exposure.light->setting.exposure_s;
  share.frames = exposure.light->frames;
  share.saturated = Share(pixels - unsaturated, pixels);
  share.underexposed = Share(CountFlagged(rate, kUnderexposed), pixels);
  share.valid = Share(pixels - CountFlagged(rate, 0xFF), pixels);
  return share;
}

void ReportInvalid(const MeasuredImage& merged, BracketReport& report) {
  const auto mask = merged.mask.pixels();
  const auto share_of = [&](auto&& is) {
    return Share(static_cast<size_t>(std::count_if(mask.begin(), mask.end(), is)), mask.size());
  };
  report.invalid_share = share_of([](uint8_t m) { return m != 0; });
  report.all_saturated_share = share_of([](uint8_t m) { return m == kSaturated; });
  report.all_dark_share = share_of([](uint8_t m) { return m == kUnderexposed; });
}

}  // namespace

absl::StatusOr<ReducedRate> ReduceRate(std::span<const Stack> exposures,
                                       const Calibration& calibration,
                                       const ReduceOptions& options) {
  EYEBOX_ASSIGN_OR_RETURN(const std::vector<Exposure> bracket,
                          OrderBracket(exposures, calibration, options));
  const Image<float> expected =
      ExpectedRate(bracket, calibration, {options.smoothing_radius, options.colour_period_px});
  ReducedRate reduced;
  BracketMerger merger;
  VarianceBudgetMeter budget(calibration.noise, calibration.linearity, expected.size());
  MeasuredImage shorter;
  double shorter_s = 0;
  for (const Exposure& exposure : bracket) {
    const double exposure_s = exposure.light->setting.exposure_s;
    EYEBOX_ASSIGN_OR_RETURN(MeasuredImage rate, RateOf(exposure, expected, calibration, options));
    reduced.report.exposures.push_back(ShareOf(exposure, rate));
    if (shorter_s > 0) {
      reduced.report.pairs.push_back(
          CompareExposures(shorter, shorter_s, rate, exposure_s, expected));
    }
    EYEBOX_RETURN_IF_ERROR(merger.Add(rate));
    budget.Add(exposure, rate, expected);
    shorter = std::move(rate);
    shorter_s = exposure_s;
  }
  EYEBOX_ASSIGN_OR_RETURN(reduced.rate, merger.Finish());
  reduced.report.hot_share = calibration.defects.hot_share;
  reduced.report.budget = budget.Mean();
  ReportInvalid(reduced.rate, reduced.report);
  return reduced;
}

absl::StatusOr<ReducedLevel> ReduceLevel(std::span<const Stack> exposures,
                                         const Calibration& calibration,
                                         const ReduceOptions& options) {
  EYEBOX_ASSIGN_OR_RETURN(ReducedRate reduced, ReduceRate(exposures, calibration, options));
  std::optional<KnownLuminance> per_unit = calibration.luminance_of_one_dn_per_s;
  MeasuredImage image = std::move(reduced.rate);
  if (calibration.flat.has_value()) {
    const MeasuredImage& response = calibration.flat->response;
    EYEBOX_ASSIGN_OR_RETURN(image, DivideByFlat(std::move(image), response, options.flat_minimum));
    reduced.report.budget = WithFlat(reduced.report.budget, image, response);
    if (calibration.flat->luminance.has_value()) per_unit = calibration.flat->luminance;
    ReportInvalid(image, reduced.report);
  } else {
    image.history.push_back("no flat: vignetting and pixel response stay in the image");
  }
  EYEBOX_ASSIGN_OR_RETURN(LuminanceImage luminance,
                          ScaleLuminance(std::move(image), calibration.flat.has_value(), per_unit));
  return ReducedLevel{std::move(luminance), std::move(reduced.report)};
}

}  // namespace eyebox::optics
