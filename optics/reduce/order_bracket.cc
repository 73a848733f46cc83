#include "optics/reduce/order_bracket.h"

#include <algorithm>
#include <memory>
#include <string>
#include <utility>

#include "absl/strings/str_cat.h"
#include "capture/base/status.h"
#include "optics/reduce/divide_by_exposure.h"
#include "optics/reduce/linearise.h"
#include "optics/reduce/match_dark.h"
#include "optics/reduce/measure_stack.h"
#include "optics/reduce/saturation_mask.h"
#include "optics/reduce/subtract_dark.h"

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

int SaturationStep(const ReduceOptions& options) {
  return options.saturation_step_px > 0 ? options.saturation_step_px : options.colour_period_px;
}

}  // namespace

absl::StatusOr<std::vector<Exposure>> OrderBracket(std::span<const Stack> stacks,
                                                   const Calibration& calibration) {
  if (stacks.empty()) return BadInput("bracket", "it has no exposure", "record at least one");
  std::vector<Exposure> bracket;
  for (const Stack& stack : stacks) {
    EYEBOX_RETURN_IF_ERROR(CheckExposure(stack, stacks[0], calibration));
    EYEBOX_ASSIGN_OR_RETURN(std::shared_ptr<const DarkFrame> dark,
                            DarkFor(calibration, stack.setting, stack.temperature_degC));
    if (dark->image_dn.size() != stack.size()) {
      return BadInput(absl::StrCat("dark of ", Describe(dark->setting)),
                      "its size differs from the light's",
                      "record both with one region of interest");
    }
    bracket.push_back({&stack, std::move(dark), {}});
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

void MaskSaturation(Rows rows, const ReduceOptions& options, std::span<Exposure> bracket) {
  for (Exposure& exposure : bracket) {
    exposure.saturation =
        SaturationMask(*exposure.light, options.saturation_dilation, SaturationStep(options), rows);
    exposure.saturation_first_row = rows.first;
  }
}

absl::StatusOr<MeasuredImage> CountsOf(const Exposure& exposure,
                                       const Image<float>& expected_rate_dn_s,
                                       const Calibration& calibration,
                                       const ReduceOptions& options) {
  MeasuredImage light = MeasureStack(exposure, expected_rate_dn_s, calibration.noise,
                                     calibration.defects, options.rail_guard_sigmas);
  EYEBOX_ASSIGN_OR_RETURN(light,
                          SubtractDark(std::move(light), exposure.light->setting, *exposure.dark));
  if (!calibration.linearity) return light;
  return Linearise(std::move(light), *calibration.linearity);
}

absl::StatusOr<MeasuredImage> RateOf(const Exposure& exposure,
                                     const Image<float>& expected_rate_dn_s,
                                     const Calibration& calibration, const ReduceOptions& options) {
  EYEBOX_ASSIGN_OR_RETURN(MeasuredImage counts,
                          CountsOf(exposure, expected_rate_dn_s, calibration, options));
  return DivideByExposure(std::move(counts), exposure.light->setting.exposure_s);
}

}  // namespace eyebox::optics
