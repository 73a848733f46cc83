#include "optics/reduce/reduce_level.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "capture/base/status.h"
#include "optics/photometry/scale_luminance.h"
#include "optics/reduce/compare_exposures.h"
#include "optics/reduce/divide_by_exposure.h"
#include "optics/reduce/divide_by_flat.h"
#include "optics/reduce/expected_rate.h"
#include "optics/reduce/measure_stack.h"
#include "optics/reduce/merge_bracket.h"
#include "optics/reduce/saturation_mask.h"
#include "optics/reduce/subtract_dark.h"
#include "optics/reduce/variance_budget.h"

namespace eyebox::optics {
namespace {

absl::Status CheckExposure(const Stack& stack, const Stack& first, const Calibration& calibration) {
  const std::string where = absl::StrCat("stack of ", Describe(stack.setting));
  if (!(stack.setting.exposure_s > 0)) {
    return BadInput(where, "the exposure is not above 0 s", "state the exposure of every frame");
  }
  if (stack.frames < 1 || stack.mean_dn.empty()) {
    return BadInput(where, "it holds no frame", "record at least one");
  }
  if (stack.size() != first.size() || stack.size() != calibration.defects.defective.size()) {
    return BadInput(where, "its size differs from the first exposure's or the darks'",
                    "record lights and darks with one region of interest");
  }
  if (!SameSetting({1, stack.setting.gain_db}, {1, calibration.noise.gain_db})) {
    return BadInput(where,
                    absl::StrCat("the noise model is of gain ", calibration.noise.gain_db, " dB"),
                    "record darks and lights with one gain");
  }
  return absl::OkStatus();
}

// Ascending exposure, each with its dark and its saturation mask.
absl::StatusOr<std::vector<Exposure>> OrderBracket(std::span<const Stack> stacks,
                                                   const Calibration& calibration,
                                                   const ReduceOptions& options) {
  if (stacks.empty()) return BadInput("bracket", "it has no exposure", "record at least one");
  std::vector<Exposure> bracket;
  for (const Stack& stack : stacks) {
    EYEBOX_RETURN_IF_ERROR(CheckExposure(stack, stacks[0], calibration));
    EYEBOX_ASSIGN_OR_RETURN(const DarkFrame* dark, FindDark(calibration, stack.setting));
    if (dark->image_dn.size() != stack.size()) {
      return BadInput(absl::StrCat("dark of ", Describe(dark->setting)),
                      "its size differs from the light's",
                      "record both with one region of interest");
    }
    bracket.push_back(
        {&stack, dark,
         SaturationMask(stack, options.saturation_dilation, options.colour_period_px)});
  }
  std::sort(bracket.begin(), bracket.end(), [](const Exposure& a, const Exposure& b) {
    return a.light->setting.exposure_s < b.light->setting.exposure_s;
  });
  for (size_t i = 1; i < bracket.size(); ++i) {
    if (SameSetting(bracket[i - 1].light->setting, bracket[i].light->setting)) {
      return BadInput("bracket",
                      absl::StrCat("two stacks of ", Describe(bracket[i].light->setting)),
                      "add frames of one setting to one stack");
    }
  }
  return bracket;
}

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

absl::StatusOr<MeasuredImage> RateOf(const Exposure& exposure, const Image<float>& expected,
                                     const Calibration& calibration, const ReduceOptions& options) {
  const Setting& setting = exposure.light->setting;
  MeasuredImage light = MeasureStack(exposure, expected, calibration.noise, calibration.defects,
                                     options.rail_guard_sigmas);
  EYEBOX_ASSIGN_OR_RETURN(light, SubtractDark(std::move(light), setting, *exposure.dark));
  return DivideByExposure(std::move(light), setting.exposure_s);
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
  VarianceBudgetMeter budget(calibration.noise, expected.size());
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
