#include <cmath>
#include <cstddef>
#include <string>

#include "absl/strings/str_format.h"
#include "capture/base/csv.h"
#include "capture/base/status.h"
#include "fit/renderer/delta_sweep.h"

namespace eyebox::fit {

absl::StatusOr<DeltaSweep> ReadDeltaSweep(const std::filesystem::path& file, int size) {
  EYEBOX_ASSIGN_OR_RETURN(const CsvTable table, ReadCsv(file));
  EYEBOX_ASSIGN_OR_RETURN(const size_t cube, table.Column("cube"));
  EYEBOX_ASSIGN_OR_RETURN(const size_t u, table.Column("u"));
  EYEBOX_ASSIGN_OR_RETURN(const size_t t, table.Column("t"));
  DeltaSweep sweep{size, {}};
  for (size_t row = 0; row < table.RowCount(); ++row) {
    DeltaReading reading;
    EYEBOX_ASSIGN_OR_RETURN(const long index, table.WholeNumber(row, cube));
    EYEBOX_ASSIGN_OR_RETURN(reading.u, table.Number(row, u));
    EYEBOX_ASSIGN_OR_RETURN(reading.t, table.Number(row, t));
    if (index < 1 || index > size) {
      return BadInput(table.Where(row, cube), absl::StrFormat("there is no entry %d", index),
                      absl::StrFormat("give 1 to %d, or the table's --size", size));
    }
    if (reading.u < 0) return BadInput(table.Where(row, u), "below 0", "give the rendered value");
    if (reading.t < 0 || reading.t > 1) {
      return BadInput(table.Where(row, t), "outside [0, 1]", "give t = s(v), v in [0, 1]");
    }
    reading.cube = static_cast<int>(index);
    sweep.readings.push_back(reading);
  }
  return sweep;
}

std::string EncodeDeltaSweep(const DeltaSweep& sweep) {
  std::string text = "cube,u,t\n";
  for (const DeltaReading& reading : sweep.readings) {
    absl::StrAppendFormat(&text, "%d,%.9g,%.9g\n", reading.cube, reading.u, reading.t);
  }
  return text;
}

}  // namespace eyebox::fit
