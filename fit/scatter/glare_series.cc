#include "fit/scatter/glare_series.h"

#include <algorithm>
#include <cmath>

#include "absl/strings/str_cat.h"
#include "capture/base/status.h"

namespace eyebox::fit {
namespace {

bool IsFiniteAndNotNegative(double value) { return value >= 0 && std::isfinite(value); }

bool AreShares(const std::vector<OffsetShare>& offsets) {
  double sum = 0;
  for (const auto& [offset_deg, share] : offsets) {
    if (!IsFiniteAndNotNegative(offset_deg) || !(share > 0)) return false;
    sum += share;
  }
  return offsets.empty() || std::abs(sum - 1) < 1e-9;
}

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
  if (series.field.empty() || series.FieldAt(0) > 0) return absl::OkStatus();
  return BadInput(series.source, "the field is dark in its centre", "aim at the lit display");
}

// Where a straight line over the square of the radius has the mean of the ring.
double MeanSquare(const std::vector<FieldRing>& field, size_t ring) {
  const double inner = ring == 0 ? 0 : field[ring - 1].outer_radius_deg;
  const double outer = field[ring].outer_radius_deg;
  return (inner * inner + outer * outer) / 2;
}

// The outermost ring goes on as it is.
double Between(const std::vector<FieldRing>& field, double square) {
  if (field.size() == 1) return field.front().relative;
  size_t next = 1;
  while (next + 1 < field.size() && MeanSquare(field, next) < square) ++next;
  const double from = MeanSquare(field, next - 1);
  const double part = std::min((square - from) / (MeanSquare(field, next) - from), 1.0);
  const double value =
      field[next - 1].relative + part * (field[next].relative - field[next - 1].relative);
  return std::max(value, 0.0);
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
    if (!IsFiniteAndNotNegative(reading.diameter_deg) ||
        !IsFiniteAndNotNegative(reading.offset_deg)) {
      return BadInput(where,
                      absl::StrCat("diameter ", reading.diameter_deg, " deg, offset ",
                                   reading.offset_deg, " deg"),
                      "give angles of at least 0");
    }
    if (!AreShares(reading.offsets)) {
      return BadInput(where, "the offsets of its pixels",
                      "give angles of at least 0 and shares "
                      "above 0 that sum to 1");
    }
    if (!std::isfinite(reading.luminance)) {
      return BadInput(where, absl::StrCat("luminance ", reading.luminance),
                      "give a finite luminance or leave the reading out");
    }
    if (!IsFiniteAndNotNegative(reading.shared_sigma)) {
      return BadInput(where, absl::StrCat("shared sigma ", reading.shared_sigma),
                      "give a standard uncertainty of at least 0");
    }
    if (!(reading.luminance_sigma > 0 && std::isfinite(reading.luminance_sigma))) {
      return BadInput(where, absl::StrCat("sigma ", reading.luminance_sigma),
                      "give the standard uncertainty of the luminance, above 0");
    }
  }
  if (LargestLuminance() > 0) return absl::OkStatus();
  return BadInput(source, "no glare reading is above 0", "look whether the display was on");
}

double GlareSeries::FieldEndDeg() const {
  return field.empty() ? field_radius_deg : field.back().outer_radius_deg;
}

double GlareSeries::FieldAt(double radius_deg) const {
  if (field.empty()) return 1;
  return Between(field, radius_deg * radius_deg) / Between(field, 0);
}

double GlareSeries::LargestLuminance() const {
  double largest = readings.empty() ? 0 : readings.front().luminance;
  for (const GlareReading& reading : readings) largest = std::max(largest, reading.luminance);
  return largest;
}

}  // namespace eyebox::fit
