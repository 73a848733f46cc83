// Luminance against drive value, as it was measured.
#ifndef EYEBOX_FIT_ACTIVATION_LEVEL_SERIES_H_
#define EYEBOX_FIT_ACTIVATION_LEVEL_SERIES_H_

#include <filesystem>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"

namespace eyebox::fit {

struct LevelReading {
  double drive = 0;            // v in [0, 1]
  double luminance = 0;        // unit of the series
  double luminance_sigma = 0;  // standard uncertainty, without the scale's; 0 where not known
};

struct LevelSeries {
  std::vector<LevelReading> readings;  // ascending drive, each drive once or more
  std::string luminance_unit;          // "cd/m2" or "relative"
  double scale_relative_sigma = 0;     // common to all readings, not in their sigma
  std::string source;                  // a file or recording, for messages
  double flat_relative_sigma = 0;      // the flat's part of scale_relative_sigma
  double scatter_relative_sigma = 0;   // likewise of scattered light that was taken out

  // Errors: InvalidArgument naming source and reading (drive outside [0, 1], drives not ascending,
  // luminance or sigma negative or not finite, fewer than 4 different drives) or the source (a flat
  // line or mere noise: the luminance does not rise with the drive, so there is nothing to fit).
  absl::Status Validate() const;
  // True if every reading has a sigma above 0.
  bool HasSigmas() const;
};

// Columns `m_k,lum` and, where known, `lum_sigma`; any order, header required, cd/m2.
// Errors: NotFound, InvalidArgument naming file, line and column; those of Validate().
absl::StatusOr<LevelSeries> ReadLevelSeriesCsv(const std::filesystem::path& file);

}  // namespace eyebox::fit

#endif  // EYEBOX_FIT_ACTIVATION_LEVEL_SERIES_H_
