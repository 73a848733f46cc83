#include "fit/color/colour_series.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "absl/strings/str_cat.h"
#include "capture/base/csv.h"
#include "capture/base/status.h"
#include "fit/activation/level_series.h"

namespace eyebox::fit {
namespace {

constexpr int kFewestLevels = 3;       // of cutoff, gamma and range
constexpr size_t kEnoughToJudge = 4;   // levels of which steady rise can be asked
constexpr double kLargestValue = 1e9;  // cd/m2, of the sun's disk
constexpr std::array<const char*, 3> kDriveColumns = {"m_r", "m_g", "m_b"};
constexpr std::array<const char*, 3> kValueColumns = {"x", "y", "z"};

bool IsAlone(const Rgb& drive, size_t channel) {
  for (size_t k = 0; k < 3; ++k) {
    if (k != channel && drive[k] != 0) return false;
  }
  return true;
}

bool IsGrey(const Rgb& drive) { return drive[0] == drive[1] && drive[1] == drive[2]; }

absl::Status ValidateReading(const ColourSeries& series, size_t i) {
  const ColourReading& reading = series.readings[i];
  const std::string where = absl::StrCat(series.source, ", reading ", i + 1);
  for (size_t k = 0; k < 3; ++k) {
    if (!(reading.drive[k] >= 0 && reading.drive[k] <= 1)) {
      return BadInput(where,
                      absl::StrCat("drive value ", reading.drive[k], " of ", kChannelNames[k],
                                   " is outside [0, 1]"),
                      "divide drive values by the display's largest one");
    }
    if (!(reading.colour[k] >= 0 && reading.colour[k] <= kLargestValue)) {
      return BadInput(where,
                      absl::StrCat(kValueColumns[k], " is ", reading.colour[k],
                                   ", negative, not finite or too large"),
                      "repeat the reading, or leave it out");
    }
  }
  return absl::OkStatus();
}

absl::Status ValidateApart(const ColourSeries& series, size_t channel) {
  std::set<double> levels;
  for (const ColourReading& reading : series.readings) {
    if (!IsGrey(reading.drive) && reading.drive[channel] > 0) {
      levels.insert(reading.drive[channel]);
    }
  }
  if (levels.size() >= kFewestLevels) return absl::OkStatus();
  return BadInput(series.source,
                  absl::StrCat(kChannelNames[channel], " is driven apart from the others at only ",
                               levels.size(), " levels above 0, fewer than ", kFewestLevels),
                  absl::StrCat("measure ", kChannelNames[channel], " alone at more levels"));
}

absl::Status ValidateRise(const ColourSeries& series, size_t channel) {
  LevelSeries alone;
  alone.source = absl::StrCat(series.source, ", ", kChannelNames[channel], " alone");
  for (const ColourReading& reading : series.readings) {
    if (!IsAlone(reading.drive, channel)) continue;
    alone.readings.push_back({reading.drive[channel], reading.colour[1], 0});
  }
  if (series.LevelsAlone(channel).size() < kEnoughToJudge) return absl::OkStatus();
  std::ranges::stable_sort(alone.readings, {}, &LevelReading::drive);
  return alone.Validate();
}

}  // namespace

absl::Status ColourSeries::Validate() const {
  for (size_t i = 0; i < readings.size(); ++i) {
    EYEBOX_RETURN_IF_ERROR(ValidateReading(*this, i));
  }
  for (size_t channel = 0; channel < 3; ++channel) {
    EYEBOX_RETURN_IF_ERROR(ValidateApart(*this, channel));
  }
  for (size_t channel = 0; channel < 3; ++channel) {
    EYEBOX_RETURN_IF_ERROR(ValidateRise(*this, channel));
  }
  const Xyz largest = Largest();
  for (size_t c = 0; c < 3; ++c) {
    if (largest[c] > 0) continue;
    return BadInput(source, absl::StrCat(kValueColumns[c], " is 0 in every reading"),
                    "give the readings of a tristimulus colorimeter or spectroradiometer");
  }
  return absl::OkStatus();
}

Xyz ColourSeries::Largest() const {
  Xyz largest = {};
  for (const ColourReading& reading : readings) {
    for (size_t c = 0; c < 3; ++c) largest[c] = std::max(largest[c], reading.colour[c]);
  }
  return largest;
}

std::optional<Xyz> ColourSeries::MeanAt(const Rgb& drive) const {
  Xyz sum = {};
  int count = 0;
  for (const ColourReading& reading : readings) {
    if (reading.drive != drive) continue;
    sum = Plus(sum, reading.colour);
    ++count;
  }
  if (count == 0) return std::nullopt;
  return Xyz{sum[0] / count, sum[1] / count, sum[2] / count};
}

std::vector<double> ColourSeries::LevelsAlone(size_t channel) const {
  std::set<double> levels;
  for (const ColourReading& reading : readings) {
    if (IsAlone(reading.drive, channel) && reading.drive[channel] > 0) {
      levels.insert(reading.drive[channel]);
    }
  }
  return {levels.begin(), levels.end()};
}

absl::StatusOr<ColourSeries> ReadColourSeriesCsv(const std::filesystem::path& file) {
  EYEBOX_ASSIGN_OR_RETURN(const CsvTable table, ReadCsv(file));
  std::array<size_t, 3> drives{};
  std::array<size_t, 3> values{};
  for (size_t k = 0; k < 3; ++k) {
    EYEBOX_ASSIGN_OR_RETURN(drives[k], table.Column(kDriveColumns[k]));
    EYEBOX_ASSIGN_OR_RETURN(values[k], table.Column(kValueColumns[k]));
  }
  ColourSeries series{{}, file.string()};
  for (size_t row = 0; row < table.RowCount(); ++row) {
    ColourReading reading;
    for (size_t k = 0; k < 3; ++k) {
      EYEBOX_ASSIGN_OR_RETURN(reading.drive[k], table.Number(row, drives[k]));
      EYEBOX_ASSIGN_OR_RETURN(reading.colour[k], table.Number(row, values[k]));
      if (!(reading.drive[k] >= 0 && reading.drive[k] <= 1)) {
        return BadInput(table.Where(row, drives[k]),
                        absl::StrCat(reading.drive[k], " is outside [0, 1]"),
                        "give drive values from 0 to 1");
      }
      if (!(reading.colour[k] >= 0 && reading.colour[k] <= kLargestValue)) {
        return BadInput(table.Where(row, values[k]),
                        absl::StrCat(reading.colour[k], " is negative or too large"),
                        "give tristimulus values in cd/m2");
      }
    }
    series.readings.push_back(reading);
  }
  EYEBOX_RETURN_IF_ERROR(series.Validate());
  return series;
}

absl::StatusOr<bool> HoldsColours(const std::filesystem::path& file) {
  EYEBOX_ASSIGN_OR_RETURN(const CsvTable table, ReadCsv(file));
  return table.FindColumn("m_r").has_value();
}

}  // namespace eyebox::fit
