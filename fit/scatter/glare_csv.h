// Glare readings of a spot photometer, as a table.
#ifndef EYEBOX_FIT_SCATTER_GLARE_CSV_H_
#define EYEBOX_FIT_SCATTER_GLARE_CSV_H_

#include <filesystem>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "fit/scatter/glare_series.h"

namespace eyebox::fit {

struct GlareTable {
  GlareSeries series;
  std::vector<std::string> warnings;  // sigmas that had to be assumed
};

// Columns `diameter_deg`, `pattern` and `luminance` (cd/m2), and where known `sigma` (standard
// uncertainty) and `offset_deg` (of the disk's centre from where the photometer looks, else 0); any
// order, header required. Patterns: `disk` (bright on black), `black_disk` (black on bright),
// `full_field` and `black`, for which the diameter is not looked at. Without a column `sigma`,
// `assumed_relative_sigma` of each reading, at least a thousandth of that of the largest.
// Errors: NotFound, InvalidArgument naming file, line and column; those of GlareSeries::Validate().
absl::StatusOr<GlareTable> ReadGlareCsv(const std::filesystem::path& file, double field_radius_deg,
                                        double assumed_relative_sigma = 0.01);

}  // namespace eyebox::fit

#endif  // EYEBOX_FIT_SCATTER_GLARE_CSV_H_
