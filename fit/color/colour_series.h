// Tristimulus values against drive values, as they were measured.
#ifndef EYEBOX_FIT_COLOR_COLOUR_SERIES_H_
#define EYEBOX_FIT_COLOR_COLOUR_SERIES_H_

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "fit/color/tristimulus.h"

namespace eyebox::fit {

struct ColourReading {
  Rgb drive = {};   // in [0, 1]
  Xyz colour = {};  // cd/m2, not negative
};

struct ColourSeries {
  std::vector<ColourReading> readings;  // any order; a stimulus may be repeated
  std::string source;                   // a file, for messages

  // Errors: InvalidArgument naming source and reading (drive outside [0, 1], X, Y or Z negative or
  // not finite), or source and channel (driven apart from the others at fewer than 3 levels; its
  // luminance, measured alone at 4 levels or more, does not rise steadily with the drive value).
  absl::Status Validate() const;
  // The largest X, Y and Z of all readings: what relative errors are taken of at least a share of.
  Xyz Largest() const;
  // The mean of the readings with exactly this drive; nothing if there is none.
  std::optional<Xyz> MeanAt(const Rgb& drive) const;
  // The drive values at which `channel` was shown alone, ascending, each once, without 0.
  std::vector<double> LevelsAlone(size_t channel) const;
};

// Columns `m_r,m_g,m_b,x,y,z`; any order, header required, cd/m2.
// Errors: NotFound, InvalidArgument naming file, line and column; those of Validate().
absl::StatusOr<ColourSeries> ReadColourSeriesCsv(const std::filesystem::path& file);

// True if the header of `file` has a column `m_r`: a series of colours, not of grey levels.
// Errors: NotFound, InvalidArgument (no CSV).
absl::StatusOr<bool> HoldsColours(const std::filesystem::path& file);

}  // namespace eyebox::fit

#endif  // EYEBOX_FIT_COLOR_COLOUR_SERIES_H_
