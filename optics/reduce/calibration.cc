#include "optics/reduce/calibration.h"

#include <algorithm>

#include "absl/strings/str_cat.h"
#include "capture/base/status.h"

namespace eyebox::optics {

absl::StatusOr<DarkFrame> MeasureDark(const Stack& dark, const NoiseModel& noise) {
  if (dark.frames < 1 || dark.mean_dn.empty()) {
    return BadInput(absl::StrCat("dark of ", Describe(dark.setting)), "it holds no frame",
                    "record at least one");
  }
  DarkFrame measured{dark.setting, MakeMeasuredImage(dark.size(), "DN")};
  const auto mean = dark.mean_dn.pixels();
  const auto saturated = dark.saturated_count.pixels();
  size_t clipped = 0;
  for (size_t i = 0; i < mean.size(); ++i) {
    measured.image_dn.value.pixels()[i] = mean[i];
    measured.image_dn.variance.pixels()[i] =
        static_cast<float>(noise.MeanVariance(mean[i] - noise.bias_dn, dark.frames));
    measured.image_dn.mask.pixels()[i] = static_cast<uint8_t>(saturated[i] > 0 ? kSaturated : 0);
    clipped += mean[i] == 0 ? 1 : 0;
  }
  BlankMaskedPixels(measured.image_dn);
  measured.temperature_degC = dark.temperature_degC;
  measured.clipped_share = static_cast<double>(clipped) / static_cast<double>(mean.size());
  measured.image_dn.history.push_back(absl::StrCat("MeasureDark(", Describe(dark.setting),
                                                   ", frames ", dark.frames, ", clipped share ",
                                                   measured.clipped_share, ")"));
  return measured;
}

absl::StatusOr<const DarkFrame*> FindDark(const Calibration& calibration, const Setting& setting) {
  const auto found =
      std::find_if(calibration.darks.begin(), calibration.darks.end(),
                   [&](const DarkFrame& dark) { return SameSetting(dark.setting, setting); });
  if (found != calibration.darks.end()) return &*found;
  for (const auto& [refused, why] : calibration.refused_darks) {
    if (SameSetting(refused, setting)) {
      return BadInput(absl::StrCat("light of ", Describe(setting)), "no dark has this setting",
                      why);
    }
  }
  std::string known = "darks there are:";
  for (const DarkFrame& dark : calibration.darks) {
    absl::StrAppend(&known, " [", Describe(dark.setting), "]");
  }
  if (calibration.darks.empty()) known = "there are no darks";
  return BadInput(absl::StrCat("light of ", Describe(setting)),
                  absl::StrCat("no dark has this setting; ", known),
                  "record darks of the same exposure and gain");
}

}  // namespace eyebox::optics
