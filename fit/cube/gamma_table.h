// The table of Psychtoolbox's Screen('LoadNormalizedGammaTable', window, table): 256 rows of red,
// green and blue in [0, 1]. As text: one row a line, three decimal numbers parted by blanks, no
// header, so that load('FILE') in MATLAB and Octave and numpy.loadtxt(FILE) give the 256 x 3
// matrix.
#ifndef EYEBOX_FIT_CUBE_GAMMA_TABLE_H_
#define EYEBOX_FIT_CUBE_GAMMA_TABLE_H_

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "fit/cube/design_table.h"

namespace eyebox::fit {

using GammaTable = std::vector<std::array<double, 3>>;  // [256], row i for the 8-bit value i

// Errors: InvalidArgument (target not kPtb, not 256 entries, entries outside [0, 1]).
absl::StatusOr<std::string> EncodeGammaTable(const TableDesign& table);

// Strict: exactly 256 rows of exactly three numbers in [0, 1]; lines end in LF or CRLF; nothing
// else may stand in the file but blank lines after the last row. Rows need not rise. Errors:
// NotFound, InvalidArgument naming file and line.
absl::StatusOr<GammaTable> ReadGammaTable(const std::filesystem::path& file);
// The same of text; `name` stands for it in messages.
absl::StatusOr<GammaTable> ParseGammaTable(std::string_view text, std::string_view name);

}  // namespace eyebox::fit

#endif  // EYEBOX_FIT_CUBE_GAMMA_TABLE_H_
