#include "optics/sensor/sensor_range.h"

#include <cmath>

#include "absl/strings/str_cat.h"
#include "capture/base/status.h"

namespace eyebox::optics {

double SensorRange::SaturationDn() const {
  return std::floor(FullScaleDn() * (1 - saturation_margin));
}

absl::Status Validate(const SensorRange& range) {
  if (range.bits < 1 || range.bits > 16) {
    return BadInput("sensor range", absl::StrCat("bits = ", range.bits),
                    "give the significant bits of the counts, 1 to 16");
  }
  if (!(range.saturation_margin >= 0 && range.saturation_margin <= 0.5)) {
    return BadInput("sensor range", absl::StrCat("saturation_margin = ", range.saturation_margin),
                    "give a fraction of full scale from 0 to 0.5");
  }
  return absl::OkStatus();
}

}  // namespace eyebox::optics
