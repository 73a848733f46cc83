#include "fit/scatter/glare_csv.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "capture/base/csv.h"
#include "capture/base/status.h"

namespace eyebox::fit {
namespace {

struct Columns {
  size_t diameter = 0;
  size_t pattern = 0;
  size_t luminance = 0;
  std::optional<size_t> sigma;
  std::optional<size_t> offset;
};

absl::StatusOr<Columns> FindColumns(const CsvTable& table) {
  Columns columns;
  EYEBOX_ASSIGN_OR_RETURN(columns.diameter, table.Column("diameter_deg"));
  EYEBOX_ASSIGN_OR_RETURN(columns.pattern, table.Column("pattern"));
  EYEBOX_ASSIGN_OR_RETURN(columns.luminance, table.Column("luminance"));
  columns.sigma = table.FindColumn("sigma");
  columns.offset = table.FindColumn("offset_deg");
  return columns;
}

// A plain field is a disk of no size: bright without a hole in it, or black without a disk.
absl::StatusOr<GlareReading> ReadStimulus(const CsvTable& table, size_t row,
                                          const Columns& columns) {
  const std::string pattern(table.Field(row, columns.pattern));
  if (pattern == "full_field") return GlareReading{.pattern = GlarePattern::kBlackDisk};
  if (pattern == "black") return GlareReading{.pattern = GlarePattern::kBrightDisk};
  GlareReading reading;
  if (pattern != "disk" && pattern != "black_disk") {
    return BadInput(table.Where(row, columns.pattern), absl::StrCat("\"", pattern, "\""),
                    "give disk, black_disk, full_field or black");
  }
  reading.pattern = pattern == "disk" ? GlarePattern::kBrightDisk : GlarePattern::kBlackDisk;
  EYEBOX_ASSIGN_OR_RETURN(reading.diameter_deg, table.Number(row, columns.diameter));
  if (reading.diameter_deg > 0) return reading;
  return BadInput(table.Where(row, columns.diameter), absl::StrCat("is ", reading.diameter_deg),
                  "give the diameter of the disk, above 0 deg");
}

absl::StatusOr<GlareReading> ReadRow(const CsvTable& table, size_t row, const Columns& columns) {
  EYEBOX_ASSIGN_OR_RETURN(GlareReading reading, ReadStimulus(table, row, columns));
  EYEBOX_ASSIGN_OR_RETURN(reading.luminance, table.Number(row, columns.luminance));
  if (columns.offset) {
    EYEBOX_ASSIGN_OR_RETURN(reading.offset_deg, table.Number(row, *columns.offset));
    if (reading.offset_deg < 0) {
      return BadInput(table.Where(row, *columns.offset), absl::StrCat("is ", reading.offset_deg),
                      "give an angle of at least 0 deg");
    }
  }
  if (!columns.sigma) return reading;
  EYEBOX_ASSIGN_OR_RETURN(reading.luminance_sigma, table.Number(row, *columns.sigma));
  if (reading.luminance_sigma > 0) return reading;
  return BadInput(table.Where(row, *columns.sigma), absl::StrCat("is ", reading.luminance_sigma),
                  "give the standard uncertainty of the reading, above 0");
}

}  // namespace

absl::StatusOr<GlareTable> ReadGlareCsv(const std::filesystem::path& file, double field_radius_deg,
                                        double assumed_relative_sigma) {
  EYEBOX_ASSIGN_OR_RETURN(const CsvTable table, ReadCsv(file));
  EYEBOX_ASSIGN_OR_RETURN(const Columns columns, FindColumns(table));
  GlareTable result;
  result.series.field_radius_deg = field_radius_deg;
  result.series.luminance_unit = "cd/m2";
  result.series.source = file.filename().string();
  for (size_t row = 0; row < table.RowCount(); ++row) {
    EYEBOX_ASSIGN_OR_RETURN(const GlareReading reading, ReadRow(table, row, columns));
    result.series.readings.push_back(reading);
  }
  if (!columns.sigma) {
    const double least = 1e-3 * result.series.LargestLuminance();
    for (GlareReading& reading : result.series.readings) {
      reading.luminance_sigma =
          assumed_relative_sigma * std::max(std::abs(reading.luminance), least);
    }
    result.warnings.push_back(absl::StrFormat(
        "no column sigma: %.3g %% of each reading were taken, at least those of a thousandth of "
        "the largest; where the readings scatter more, all sigmas are raised to that",
        100 * assumed_relative_sigma));
  }
  EYEBOX_RETURN_IF_ERROR(result.series.Validate());
  return result;
}

}  // namespace eyebox::fit
