#include "fit/scatter/glare_series.h"

#include <algorithm>
#include <cmath>

#include "absl/strings/str_cat.h"
#include "capture/base/status.h"

namespace eyebox::fit {
namespace {

bool IsAngle(double value) { return value >= 0 && std::isfinite(value); }

absl::Status CheckField(const GlareSeries& series) {
  double inner = 0;
  for (size_t i = 0; i < series.field.size(); ++i) {
    const auto [outer, relative] = series.field[i];
    if (!(outer > inner && std::isfinite(outer) && relative >= 0 && std::isfinite(relative))) {
      return BadInput(absl::StrCat(series.source, ", ring ", i + 1, " of the field"),
                      absl::StrCat("outer radius ", outer, " deg, relative luminance ", relative),
                      "give rising radii and luminances of at least 0");
    }
    inner = outer;
  }
  return absl::OkStatus();
}

}  // namespace

absl::Status GlareSeries::Validate() const {
  if (readings.size() < 4) {
    return BadInput(source, absl::StrCat(readings.size(), " glare readings"),
                    "measure at least 4 disks");
  }
  if (!(field_radius_deg > 0 && std::isfinite(field_radius_deg))) {
    return BadInput(source, absl::StrCat("field radius ", field_radius_deg, " deg"),
                    "give the radius of the display's field, above 0");
  }
  EYEBOX_RETURN_IF_ERROR(CheckField(*this));
  for (size_t i = 0; i < readings.size(); ++i) {
    const GlareReading& reading = readings[i];
    const std::string where = absl::StrCat(source, ", glare reading ", i + 1);
    if (!IsAngle(reading.diameter_deg) || !IsAngle(reading.offset_deg)) {
      return BadInput(where,
                      absl::StrCat("diameter ", reading.diameter_deg, " deg, offset ",
                                   reading.offset_deg, " deg"),
                      "give angles of at least 0");
    }
    if (!std::isfinite(reading.luminance)) {
      return BadInput(where, absl::StrCat("luminance ", reading.luminance),
                      "give a finite luminance or leave the reading out");
    }
    if (!(reading.luminance_sigma > 0 && std::isfinite(reading.luminance_sigma))) {
      return BadInput(where, absl::StrCat("sigma ", reading.luminance_sigma),
                      "give the standard uncertainty of the luminance, above 0");
    }
  }
  if (LargestLuminance() > 0) return absl::OkStatus();
  return BadInput(source, "no glare reading is above 0", "look whether the display was on");
}

double GlareSeries::LargestLuminance() const {
  double largest = readings.empty() ? 0 : readings.front().luminance;
  for (const GlareReading& reading : readings) largest = std::max(largest, reading.luminance);
  return largest;
}

}  // namespace eyebox::fit
