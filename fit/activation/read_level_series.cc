#include <algorithm>
#include <optional>

#include "absl/strings/str_cat.h"
#include "capture/base/csv.h"
#include "capture/base/status.h"
#include "fit/activation/level_series.h"

namespace eyebox::fit {
namespace {

// The line is known here and lost once the readings are sorted.
absl::StatusOr<double> NumberWithin(const CsvTable& table, size_t row, size_t column, double upper,
                                    std::string_view remedy) {
  EYEBOX_ASSIGN_OR_RETURN(const double value, table.Number(row, column));
  if (value >= 0 && value <= upper) return value;
  return BadInput(table.Where(row, column),
                  absl::StrCat(value, value < 0 ? " is negative" : " is too large"), remedy);
}

}  // namespace

absl::StatusOr<LevelSeries> ReadLevelSeriesCsv(const std::filesystem::path& file) {
  constexpr double kLargestLuminance = 1e9;  // cd/m2, of the sun's disk
  EYEBOX_ASSIGN_OR_RETURN(const CsvTable table, ReadCsv(file));
  EYEBOX_ASSIGN_OR_RETURN(const size_t drive, table.Column("m_k"));
  EYEBOX_ASSIGN_OR_RETURN(const size_t luminance, table.Column("lum"));
  const std::optional<size_t> sigma = table.FindColumn("lum_sigma");
  LevelSeries series{{}, "cd/m2", 0, file.string()};
  for (size_t row = 0; row < table.RowCount(); ++row) {
    LevelReading reading;
    EYEBOX_ASSIGN_OR_RETURN(reading.drive,
                            NumberWithin(table, row, drive, 1, "give drive values from 0 to 1"));
    EYEBOX_ASSIGN_OR_RETURN(reading.luminance,
                            NumberWithin(table, row, luminance, kLargestLuminance, "give cd/m2"));
    if (sigma) {
      EYEBOX_ASSIGN_OR_RETURN(reading.luminance_sigma,
                              NumberWithin(table, row, *sigma, kLargestLuminance,
                                           "give the standard uncertainty in cd/m2, 0 if unknown"));
    }
    series.readings.push_back(reading);
  }
  std::stable_sort(series.readings.begin(), series.readings.end(),
                   [](const auto& a, const auto& b) { return a.drive < b.drive; });
  EYEBOX_RETURN_IF_ERROR(series.Validate());
  return series;
}

}  // namespace eyebox::fit
