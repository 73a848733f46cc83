// Which controls must have which value, so that a count is proportional to light.
#include <linux/videodev2.h>

#include <array>

#include "capture/base/status.h"
#include "capture/camera/v4l2/video_controls.h"

namespace eyebox::capture {
namespace {

enum class Wanted { kValue, kDefault, kMinimum };

struct Rule {
  uint32_t id;
  Wanted wanted;
  int32_t value = 0;
};

// In this order: what is automatic first, since it locks what it governs.
constexpr std::array kRules = {
    Rule{V4L2_CID_EXPOSURE_AUTO, Wanted::kValue, V4L2_EXPOSURE_MANUAL},
    Rule{V4L2_CID_EXPOSURE_AUTO_PRIORITY, Wanted::kValue, 0},  // stretches the frame interval
    Rule{V4L2_CID_AUTO_EXPOSURE_BIAS, Wanted::kDefault},
    Rule{V4L2_CID_ISO_SENSITIVITY_AUTO, Wanted::kValue, V4L2_ISO_SENSITIVITY_MANUAL},
    Rule{V4L2_CID_AUTOGAIN, Wanted::kValue, 0},
    Rule{V4L2_CID_CHROMA_AGC, Wanted::kValue, 0},
    Rule{V4L2_CID_AUTO_WHITE_BALANCE, Wanted::kValue, 0},
    Rule{V4L2_CID_AUTO_N_PRESET_WHITE_BALANCE, Wanted::kValue, V4L2_WHITE_BALANCE_MANUAL},
    Rule{V4L2_CID_HUE_AUTO, Wanted::kValue, 0},
    Rule{V4L2_CID_AUTOBRIGHTNESS, Wanted::kValue, 0},
    Rule{V4L2_CID_WIDE_DYNAMIC_RANGE, Wanted::kValue, 0},
    Rule{V4L2_CID_IMAGE_STABILIZATION, Wanted::kValue, 0},
    Rule{V4L2_CID_SCENE_MODE, Wanted::kValue, V4L2_SCENE_MODE_NONE},
    Rule{V4L2_CID_FOCUS_AUTO, Wanted::kValue, 0},
    Rule{V4L2_CID_BACKLIGHT_COMPENSATION, Wanted::kValue, 0},
    Rule{V4L2_CID_POWER_LINE_FREQUENCY, Wanted::kValue, V4L2_CID_POWER_LINE_FREQUENCY_DISABLED},
    Rule{V4L2_CID_BAND_STOP_FILTER, Wanted::kValue, 0},
    Rule{V4L2_CID_COLORFX, Wanted::kValue, V4L2_COLORFX_NONE},
    Rule{V4L2_CID_SHARPNESS, Wanted::kMinimum},
    Rule{V4L2_CID_BLACK_LEVEL, Wanted::kDefault},
    Rule{V4L2_CID_BRIGHTNESS, Wanted::kDefault},
    Rule{V4L2_CID_CONTRAST, Wanted::kDefault},
    Rule{V4L2_CID_SATURATION, Wanted::kDefault},
    Rule{V4L2_CID_HUE, Wanted::kDefault},
    Rule{V4L2_CID_RED_BALANCE, Wanted::kDefault},
    Rule{V4L2_CID_BLUE_BALANCE, Wanted::kDefault},
    Rule{V4L2_CID_WHITE_BALANCE_TEMPERATURE, Wanted::kDefault},
    Rule{V4L2_CID_DIGITAL_GAIN, Wanted::kDefault},
    // Where there is an analogue gain too; the gain that Eyebox governs is set after this.
    Rule{V4L2_CID_GAIN, Wanted::kMinimum},
    Rule{V4L2_CID_HFLIP, Wanted::kValue, 0},  // a flip shifts the Bayer pattern
    Rule{V4L2_CID_VFLIP, Wanted::kValue, 0},
};

int32_t WantedValue(const Rule& rule, const Control& control) {
  switch (rule.wanted) {
    case Wanted::kValue:
      return rule.value;
    case Wanted::kDefault:
      return control.default_value;
    case Wanted::kMinimum:
      return control.minimum;
  }
  return rule.value;
}

absl::StatusOr<HeldControl> Hold(const VideoNode& node, const Control& control, int32_t value) {
  EYEBOX_ASSIGN_OR_RETURN(const int32_t reads, WriteControl(node, control, value));
  if (reads == value) return HeldControl{.control = control, .value = value};
  return DeviceFailed(node.path() + " control '" + control.name + "'",
                      "stays at " + std::to_string(reads) + " instead of " + std::to_string(value),
                      "set it by hand (`v4l2-ctl`) or use a camera that lets it be switched off");
}

// The USB Video Class counts gamma in hundredths; elsewhere V4L2 gives it no unit.
absl::StatusOr<int32_t> LinearGamma(const VideoNode& node, const Control& control,
                                    const V4l2Options& options) {
  if (options.gamma) return *options.gamma;
  if (node.driver() == "uvcvideo") return 100;
  return BadInput(options.uri,
                  "has a control '" + control.name + "' (" + std::to_string(control.minimum) +
                      " to " + std::to_string(control.maximum) +
                      ") and its driver does not tell which value is linear",
                  "look it up in the data sheet and add gamma=VALUE to the URI");
}

absl::StatusOr<std::optional<HeldControl>> HoldGamma(const VideoNode& node,
                                                     const V4l2Options& options) {
  EYEBOX_ASSIGN_OR_RETURN(const auto control, FindControl(node, V4L2_CID_GAMMA));
  if (!control) return std::nullopt;
  EYEBOX_ASSIGN_OR_RETURN(const int32_t linear, LinearGamma(node, *control, options));
  return Hold(node, *control, linear);
}

}  // namespace

absl::StatusOr<std::vector<HeldControl>> MakeManual(const VideoNode& node,
                                                    const V4l2Options& options) {
  std::vector<HeldControl> held;
  for (const Rule& rule : kRules) {
    EYEBOX_ASSIGN_OR_RETURN(const auto control, FindControl(node, rule.id));
    if (!control) continue;
    EYEBOX_ASSIGN_OR_RETURN(const HeldControl one,
                            Hold(node, *control, WantedValue(rule, *control)));
    held.push_back(one);
  }
  EYEBOX_ASSIGN_OR_RETURN(const auto gamma, HoldGamma(node, options));
  if (gamma) held.push_back(*gamma);
  return held;
}

}  // namespace eyebox::capture
