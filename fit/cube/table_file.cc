#include "fit/cube/table_file.h"

#include "absl/strings/str_cat.h"
#include "capture/base/file.h"
#include "capture/base/status.h"
#include "fit/cube/cube_parser.h"
#include "fit/cube/gamma_table.h"

namespace eyebox::fit {
namespace {

// 129^3 entries of three numbers with nine digits each take about 80 MB.
constexpr size_t kLargestCubeBytes = size_t{256} << 20;

}  // namespace

Cube3d ToCube(const TableDesign& table, const std::string& title) {
  Cube3d cube;
  cube.size = table.size;
  cube.title = title;
  cube.entries.reserve(table.entries.size() * table.entries.size() * table.entries.size());
  for (double blue : table.entries) {
    for (double green : table.entries) {
      for (double red : table.entries) cube.entries.push_back({red, green, blue});
    }
  }
  return cube;
}

absl::StatusOr<Cube3d> ReadCube(const std::filesystem::path& file) {
  EYEBOX_ASSIGN_OR_RETURN(const std::string text, ReadWholeFile(file, kLargestCubeBytes));
  return ParseCube(text, file.string());
}

absl::StatusOr<std::string> EncodeTable(const TableDesign& table) {
  if (table.target == TableTarget::kPps) return EncodeStrip(table);
  if (table.target == TableTarget::kPtb) return EncodeGammaTable(table);
  return EncodeCube(ToCube(table, absl::StrCat("Eyebox, for ", std::string(NameOf(table.target)),
                                               ", size ", table.size)));
}

}  // namespace eyebox::fit
