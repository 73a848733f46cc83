#include "fit/activation/level_series.h"

#include <algorithm>
#include <cmath>

#include "absl/strings/str_cat.h"
#include "capture/base/status.h"

namespace eyebox::fit {
namespace {

constexpr int kFewestDrives = 4;
// White must stand above black by this share of white; a display that does less shows no levels.
constexpr double kSmallestRise = 0.01;
// Of the pairs of readings at different drives, rising less falling: 1 for an activation, around
// 0.2 for noise. A display whose dark half drowns in noise still reaches 0.75.
constexpr double kFewestConcordant = 0.6;

std::string ReadingName(const LevelSeries& series, size_t i) {
  return absl::StrCat(series.source, ", reading ", i + 1);
}

bool IsMeasure(double value) { return std::isfinite(value) && value >= 0; }

absl::Status ValidateReading(const LevelSeries& series, size_t i) {
  const LevelReading& reading = series.readings[i];
  if (!(reading.drive >= 0 && reading.drive <= 1)) {
    return BadInput(ReadingName(series, i),
                    absl::StrCat("drive value ", reading.drive, " is outside [0, 1]"),
                    "divide drive values by the display's largest one");
  }
  if (!IsMeasure(reading.luminance)) {
    return BadInput(ReadingName(series, i),
                    absl::StrCat("luminance ", reading.luminance, " is negative or not finite"),
                    "repeat the reading, or leave it out");
  }
  if (!IsMeasure(reading.luminance_sigma)) {
    return BadInput(ReadingName(series, i),
                    absl::StrCat("sigma ", reading.luminance_sigma, " is negative or not finite"),
                    "give a standard uncertainty, or 0 where it is not known");
  }
  if (i > 0 && reading.drive < series.readings[i - 1].drive) {
    return BadInput(ReadingName(series, i), "its drive value is below the one before",
                    "sort the readings by drive value");
  }
  return absl::OkStatus();
}

int CountDrives(const std::vector<LevelReading>& ascending) {
  int count = 0;
  for (size_t i = 0; i < ascending.size(); ++i) {
    count += i == 0 || ascending[i].drive > ascending[i - 1].drive ? 1 : 0;
  }
  return count;
}

double MeanAt(const std::vector<LevelReading>& readings, double drive) {
  double sum = 0;
  int count = 0;
  for (const LevelReading& reading : readings) {
    if (reading.drive != drive) continue;
    sum += reading.luminance;
    ++count;
  }
  return sum / count;
}

// Kendall's: equal luminances count for neither side.
double Concordance(const std::vector<LevelReading>& ascending) {
  double rising = 0;
  double falling = 0;
  for (size_t i = 0; i < ascending.size(); ++i) {
    for (size_t j = i + 1; j < ascending.size(); ++j) {
      if (ascending[j].drive == ascending[i].drive) continue;
      rising += ascending[j].luminance > ascending[i].luminance ? 1 : 0;
      falling += ascending[j].luminance < ascending[i].luminance ? 1 : 0;
    }
  }
  return rising + falling > 0 ? (rising - falling) / (rising + falling) : 0;
}

}  // namespace

absl::Status LevelSeries::Validate() const {
  for (size_t i = 0; i < readings.size(); ++i) {
    EYEBOX_RETURN_IF_ERROR(ValidateReading(*this, i));
  }
  const int drives = CountDrives(readings);
  if (drives < kFewestDrives) {
    return BadInput(
        source,
        absl::StrCat("it has ", drives, " different drive values, fewer than ", kFewestDrives),
        "measure more levels between black and white");
  }
  const double black = MeanAt(readings, readings.front().drive);
  const double white = MeanAt(readings, readings.back().drive);
  if (!(white - black >= kSmallestRise * white && white > 0)) {
    return BadInput(source,
                    absl::StrCat("the luminance does not rise with the drive value: ", black,
                                 " at the lowest, ", white, " at the highest"),
                    "check that the display showed the levels and that the instrument saw them");
  }
  const double concordance = Concordance(readings);
  if (concordance < kFewestConcordant) {
    return BadInput(
        source,
        absl::StrCat("the luminance does not rise steadily with the drive value: of the "
                     "pairs of readings, rising less falling is ",
                     concordance, ", an activation has nearly 1"),
        "check the order of the levels, and average more readings if it is noise");
  }
  return absl::OkStatus();
}

bool LevelSeries::HasSigmas() const {
  return !readings.empty() &&
         std::all_of(readings.begin(), readings.end(),
                     [](const LevelReading& reading) { return reading.luminance_sigma > 0; });
}

}  // namespace eyebox::fit
