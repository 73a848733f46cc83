// Tables on disk: .cube (Adobe "Cube LUT Specification" 1.0) and the strip PNG of Unity's
// Post-Processing Stack: n rows, n^2 columns, the n slices of the cube side by side (Murray et al.
// 2022, eq 1, 2). Column j belongs to red j mod n and blue floor(j / n); green counts the rows
// from the bottom, where Unity puts the origin of a texture.
#ifndef EYEBOX_FIT_CUBE_TABLE_FILE_H_
#define EYEBOX_FIT_CUBE_TABLE_FILE_H_

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "fit/cube/design_table.h"

namespace eyebox::fit {

struct Cube3d {
  int size = 0;
  std::string title;
  std::array<double, 3> domain_min = {0, 0, 0};
  std::array<double, 3> domain_max = {1, 1, 1};
  std::vector<std::array<double, 3>> entries;  // [size^3], red fastest
};

// The three-dimensional table in which each channel goes through `table` by itself.
Cube3d ToCube(const TableDesign& table, const std::string& title);

// Text of a .cube file; quotes and line ends in the title become blanks, numbers in the shortest
// decimal form that reads back to the same float32.
std::string EncodeCube(const Cube3d& cube);
// Strict: unknown keywords, missing or surplus entries and numbers out of range are refused.
// Errors: NotFound, InvalidArgument naming file and line.
absl::StatusOr<Cube3d> ReadCube(const std::filesystem::path& file);

// Bytes of the strip PNG. Errors: InvalidArgument (size outside 2 to 32, target not kPps, entries
// outside [0, 1]).
absl::StatusOr<std::string> EncodeStrip(const TableDesign& table);
absl::StatusOr<std::string> EncodeStrip(const Cube3d& cube);
// Entries in [0, 1]. Errors: NotFound, InvalidArgument (not n x n^2), DataLoss; each names the
// file.
absl::StatusOr<Cube3d> ReadStrip(const std::filesystem::path& file);

// The bytes of the file that the target loads: .cube text, PNG, or the text of gamma_table.h.
absl::StatusOr<std::string> EncodeTable(const TableDesign& table);

}  // namespace eyebox::fit

#endif  // EYEBOX_FIT_CUBE_TABLE_FILE_H_
