#include "capture/camera/aravis/known_state.h"

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "capture/base/status.h"
#include "capture/camera/aravis/verified.h"

namespace eyebox::capture::aravis {
namespace {

// Names of the GenICam Standard Features Naming Convention 2.7, and what makers used before it.
constexpr std::array kOff = {"ExposureAuto",     "GainAuto",         "BlackLevelAuto",
                             "BalanceWhiteAuto", "GammaAuto",        "SharpnessAuto",
                             "HueAuto",          "SaturationAuto",   "AcquisitionFrameRateAuto",
                             "TestPattern",      "TestImageSelector"};
constexpr std::array kSwitchedOff = {"GammaEnable",
                                     "GammaEnabled",
                                     "LUTEnable",
                                     "SharpeningEnable",
                                     "SharpnessEnable",
                                     "SharpnessEnabled",
                                     "HueEnabled",
                                     "SaturationEnable",
                                     "SaturationEnabled",
                                     "ColorTransformationEnable",
                                     "BlackLevelClampingEnable",
                                     "ReverseX",
                                     "ReverseY",
                                     "ChunkModeActive"};
constexpr std::array kOne = {"BinningHorizontal", "BinningVertical", "DecimationHorizontal",
                             "DecimationVertical"};
struct Choice {
  const char* feature;
  const char* value;
};
constexpr std::array kChosen = {Choice{"ExposureMode", "Timed"},
                                Choice{"AcquisitionMode", "Continuous"},
                                Choice{"DeviceStreamChannelEndianness", "Little"}};
constexpr std::array kGainSelectors = {"AnalogAll", "All"};

absl::Status ClearTriggers(Device& device) {
  if (!device.Has("TriggerMode")) return absl::OkStatus();
  std::vector<std::string> selectors = {""};
  if (device.Has("TriggerSelector")) {
    EYEBOX_ASSIGN_OR_RETURN(selectors, device.Choices("TriggerSelector"));
  }
  for (const std::string& selector : selectors) {
    if (!selector.empty()) EYEBOX_RETURN_IF_ERROR(HoldText(device, "TriggerSelector", selector));
    if (!device.Has("TriggerMode")) continue;
    EYEBOX_RETURN_IF_ERROR(HoldText(device, "TriggerMode", "Off"));
  }
  return absl::OkStatus();
}

absl::Status SwitchEverythingAutomaticOff(Device& device) {
  for (const char* feature : kOff) {
    if (device.Has(feature)) EYEBOX_RETURN_IF_ERROR(HoldText(device, feature, "Off"));
  }
  for (const char* feature : kSwitchedOff) {
    if (device.Has(feature)) EYEBOX_RETURN_IF_ERROR(HoldSwitch(device, feature, false));
  }
  for (const char* feature : kOne) {
    if (device.Has(feature)) EYEBOX_RETURN_IF_ERROR(HoldInteger(device, feature, 1));
  }
  for (const auto& [feature, value] : kChosen) {
    if (device.Has(feature)) EYEBOX_RETURN_IF_ERROR(HoldText(device, feature, value));
  }
  if (device.Has("Gamma")) EYEBOX_RETURN_IF_ERROR(HoldFloat(device, "Gamma", 1));
  return absl::OkStatus();
}

absl::Status Quieten(Device& device) {
  EYEBOX_RETURN_IF_ERROR(device.Execute("AcquisitionStop"));
  EYEBOX_RETURN_IF_ERROR(ClearTriggers(device));
  return SwitchEverythingAutomaticOff(device);
}

absl::Status PushRegion(Device& device, const Region& region) {
  for (const char* offset : {"OffsetX", "OffsetY"}) {
    if (device.Has(offset)) EYEBOX_RETURN_IF_ERROR(HoldInteger(device, offset, 0));
  }
  EYEBOX_RETURN_IF_ERROR(HoldInteger(device, "Width", region.size.width_px));
  EYEBOX_RETURN_IF_ERROR(HoldInteger(device, "Height", region.size.height_px));
  if (region.x_px > 0) EYEBOX_RETURN_IF_ERROR(HoldInteger(device, "OffsetX", region.x_px));
  if (region.y_px > 0) EYEBOX_RETURN_IF_ERROR(HoldInteger(device, "OffsetY", region.y_px));
  return absl::OkStatus();
}

// Returns what the gain reads back, dB.
absl::StatusOr<double> PushGain(Device& device, double gain_db) {
  for (const char* selector : kGainSelectors) {
    if (!device.Offers("GainSelector", selector)) continue;
    EYEBOX_RETURN_IF_ERROR(HoldText(device, "GainSelector", selector));
    break;
  }
  if (device.Has("Gain")) {
    EYEBOX_RETURN_IF_ERROR(device.SetFloat("Gain", gain_db));
    return device.GetFloat("Gain");
  }
  if (device.Has("GainRaw")) {
    EYEBOX_ASSIGN_OR_RETURN(const Limits<int64_t> raw, device.IntegerLimits("GainRaw"));
    EYEBOX_RETURN_IF_ERROR(HoldInteger(device, "GainRaw", raw.minimum));
  }
  return 0.0;
}

// Returns the rate that it reads back, 0 where the camera is triggered.
absl::StatusOr<double> PushFrameRate(Device& device, const CameraSettings& settings) {
  const bool free_run = settings.trigger == TriggerSource::kFreeRun;
  const bool limited = free_run && settings.frame_rate_hz > 0;
  if (device.Has("AcquisitionFrameRateEnable")) {
    EYEBOX_RETURN_IF_ERROR(HoldSwitch(device, "AcquisitionFrameRateEnable", limited));
    if (!limited) return 0.0;
  }
  if (!free_run) return 0.0;
  const std::string feature =
      device.Has("AcquisitionFrameRate") ? "AcquisitionFrameRate" : "AcquisitionFrameRateAbs";
  if (!limited && !device.Has(feature)) return 0.0;
  EYEBOX_ASSIGN_OR_RETURN(const Limits<double> limits, device.FloatLimits(feature));
  const double fastest_hz = std::min(limits.maximum, 1 / settings.exposure_s);
  const double rate_hz = limited ? settings.frame_rate_hz : std::max(limits.minimum, fastest_hz);
  if (rate_hz > limits.maximum || rate_hz < limits.minimum) {
    return BadInput(device.uri() + " frame_rate_hz", "is " + std::to_string(rate_hz),
                    "this camera takes " + std::to_string(limits.minimum) + " to " +
                        std::to_string(limits.maximum));
  }
  EYEBOX_RETURN_IF_ERROR(device.SetFloat(feature, rate_hz));
  if (!limited) return 0.0;
  return device.GetFloat(feature);
}

absl::Status PushTrigger(Device& device, const CameraSettings& settings) {
  if (settings.trigger == TriggerSource::kFreeRun) return absl::OkStatus();
  if (device.Has("TriggerSelector")) {
    EYEBOX_RETURN_IF_ERROR(HoldText(device, "TriggerSelector", "FrameStart"));
  }
  const bool line = settings.trigger == TriggerSource::kLine;
  EYEBOX_RETURN_IF_ERROR(
      HoldText(device, "TriggerSource", line ? settings.trigger_line : "Software"));
  if (line && device.Has("TriggerActivation")) {
    EYEBOX_RETURN_IF_ERROR(HoldText(device, "TriggerActivation", "RisingEdge"));
  }
  return HoldText(device, "TriggerMode", "On");
}

absl::StatusOr<PixelFormat> ChoosePixelFormat(const Device& device, const AravisOptions& options) {
  EYEBOX_ASSIGN_OR_RETURN(const std::vector<int64_t> offered, device.ChoiceValues("PixelFormat"));
  std::string names;
  for (const PixelFormat& format : KnownPixelFormats()) {
    if (std::ranges::count(offered, int64_t{format.pfnc}) == 0) continue;
    if (!options.pixel_format || *options.pixel_format == format) return format;
    names.append(" ").append(format.name);
  }
  return BadInput(device.uri() + " pixel_format", "is not offered by this camera",
                  names.empty() ? "it offers none whose counts can be read" : "ask for" + names);
}

absl::StatusOr<Region> ChooseRegion(const Device& device, const AravisOptions& options) {
  EYEBOX_ASSIGN_OR_RETURN(const Limits<int64_t> width, device.IntegerLimits("Width"));
  EYEBOX_ASSIGN_OR_RETURN(const Limits<int64_t> height, device.IntegerLimits("Height"));
  const ImageSize whole = {.width_px = static_cast<int>(width.maximum),
                           .height_px = static_cast<int>(height.maximum)};
  if (!options.region) return Region{.size = whole};
  const Region& region = *options.region;
  if (region.x_px + region.size.width_px <= whole.width_px &&
      region.y_px + region.size.height_px <= whole.height_px &&
      region.size.width_px >= width.minimum && region.size.height_px >= height.minimum) {
    return region;
  }
  return BadInput(device.uri() + " region", "is not within the sensor",
                  "the whole sensor is " + std::to_string(whole.width_px) + "x" +
                      std::to_string(whole.height_px) + "+0+0");
}

}  // namespace

absl::StatusOr<FixedState> ChooseFixedState(Device& device, const AravisOptions& options) {
  EYEBOX_RETURN_IF_ERROR(Quieten(device));
  for (const char* offset : {"OffsetX", "OffsetY"}) {
    if (device.Has(offset)) EYEBOX_RETURN_IF_ERROR(HoldInteger(device, offset, 0));
  }
  FixedState fixed;
  EYEBOX_ASSIGN_OR_RETURN(fixed.pixel_format, ChoosePixelFormat(device, options));
  EYEBOX_ASSIGN_OR_RETURN(fixed.region, ChooseRegion(device, options));
  if (device.HasBlackLevel()) {
    EYEBOX_ASSIGN_OR_RETURN(fixed.black_level, device.BlackLevel());
  }
  return fixed;
}

absl::StatusOr<CameraSettings> PushKnownState(Device& device, const FixedState& fixed,
                                              const CameraSettings& settings) {
  CameraSettings set = settings;
  EYEBOX_RETURN_IF_ERROR(Quieten(device));
  EYEBOX_RETURN_IF_ERROR(PushRegion(device, fixed.region));
  EYEBOX_RETURN_IF_ERROR(HoldInteger(device, "PixelFormat", fixed.pixel_format.pfnc));
  EYEBOX_RETURN_IF_ERROR(device.SetExposureS(settings.exposure_s));
  EYEBOX_ASSIGN_OR_RETURN(set.exposure_s, device.ExposureS());
  EYEBOX_ASSIGN_OR_RETURN(set.gain_db, PushGain(device, settings.gain_db));
  if (fixed.black_level) {
    EYEBOX_RETURN_IF_ERROR(device.SetBlackLevel(settings.black_level.value_or(*fixed.black_level)));
    EYEBOX_ASSIGN_OR_RETURN(set.black_level, device.BlackLevel());
  }
  EYEBOX_ASSIGN_OR_RETURN(set.frame_rate_hz, PushFrameRate(device, settings));
  EYEBOX_RETURN_IF_ERROR(PushTrigger(device, settings));
  return set;
}

absl::StatusOr<TriggerSources> FindTriggerSources(const Device& device) {
  TriggerSources sources;
  if (!device.Has("TriggerSource")) return sources;
  EYEBOX_ASSIGN_OR_RETURN(const std::vector<std::string> choices, device.Choices("TriggerSource"));
  for (const std::string& choice : choices) {
    if (choice == "Software") sources.software = true;
    if (choice.starts_with("Line")) sources.lines.push_back(choice);
  }
  return sources;
}

absl::StatusOr<Limits<double>> GainLimitsDb(const Device& device) {
  if (device.Has("Gain")) return device.FloatLimits("Gain");
  return Limits<double>{};
}

}  // namespace eyebox::capture::aravis
