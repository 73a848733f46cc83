#include "fit/renderer/scene_row.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>

#include "absl/strings/str_format.h"
#include "capture/base/status.h"

namespace eyebox::fit {
namespace {

constexpr double kUnitTolerance = 1e-3;
constexpr double kNoLimit = std::numeric_limits<double>::infinity();

struct Limits {
  double low = -kNoLimit;
  double high = kNoLimit;
};

absl::StatusOr<double> NumberWithin(const CsvTable& table, size_t row, const std::string& name,
                                    const Limits& limits) {
  EYEBOX_ASSIGN_OR_RETURN(const size_t column, table.Column(name));
  EYEBOX_ASSIGN_OR_RETURN(const double value, table.Number(row, column));
  if (value >= limits.low && value <= limits.high) return value;
  return BadInput(table.Where(row, column), absl::StrFormat("%g is out of range", value),
                  limits.high == kNoLimit
                      ? absl::StrFormat("give at least %g", limits.low)
                      : absl::StrFormat("give %g to %g", limits.low, limits.high));
}

absl::StatusOr<std::array<double, 3>> ThreeNumbers(const CsvTable& table, size_t row,
                                                   const std::string& prefix, const char* suffixes,
                                                   const Limits& limits) {
  std::array<double, 3> values{};
  for (size_t i = 0; i < 3; ++i) {
    EYEBOX_ASSIGN_OR_RETURN(values[i],
                            NumberWithin(table, row, prefix + "_" + suffixes[i], limits));
  }
  return values;
}

absl::StatusOr<std::array<double, 3>> UnitVector(const CsvTable& table, size_t row,
                                                 const std::string& prefix) {
  EYEBOX_ASSIGN_OR_RETURN(const auto vector, ThreeNumbers(table, row, prefix, "xyz", {}));
  const double length = std::hypot(vector[0], vector[1], vector[2]);
  if (std::abs(length - 1) <= kUnitTolerance) return vector;
  EYEBOX_ASSIGN_OR_RETURN(const size_t column, table.Column(prefix + "_x"));
  return BadInput(table.Where(row, column), absl::StrFormat("the vector has length %g", length),
                  "give a unit vector");
}

absl::Status ReadLight(const CsvTable& table, size_t row, SceneRow& scene) {
  EYEBOX_ASSIGN_OR_RETURN(scene.exposure_stops, NumberWithin(table, row, "e", {-60, 60}));
  EYEBOX_ASSIGN_OR_RETURN(const auto normal, UnitVector(table, row, "n"));
  EYEBOX_ASSIGN_OR_RETURN(const auto light, UnitVector(table, row, "l"));
  scene.facing = std::max(normal[0] * light[0] + normal[1] * light[1] + normal[2] * light[2], 0.0);
  EYEBOX_ASSIGN_OR_RETURN(scene.directional_intensity,
                          NumberWithin(table, row, "i_d", {0, kNoLimit}));
  EYEBOX_ASSIGN_OR_RETURN(scene.directional_color,
                          ThreeNumbers(table, row, "d", "rgb", {0, kNoLimit}));
  EYEBOX_ASSIGN_OR_RETURN(scene.ambient_intensity, NumberWithin(table, row, "i_a", {0, kNoLimit}));
  EYEBOX_ASSIGN_OR_RETURN(scene.ambient_color, ThreeNumbers(table, row, "a", "rgb", {0, kNoLimit}));
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<std::vector<SceneRow>> SceneRowsOf(const CsvTable& table, RowMaterial material) {
  const bool has_stored =
      table.FindColumn("v_r") && table.FindColumn("v_g") && table.FindColumn("v_b");
  std::vector<SceneRow> rows(table.RowCount());
  for (size_t row = 0; row < rows.size(); ++row) {
    EYEBOX_ASSIGN_OR_RETURN(rows[row].material, ThreeNumbers(table, row, "m", "rgb", {0, 1}));
    if (material == RowMaterial::kLambertian) {
      EYEBOX_RETURN_IF_ERROR(ReadLight(table, row, rows[row]));
    }
    if (has_stored) {
      EYEBOX_ASSIGN_OR_RETURN(rows[row].stored, ThreeNumbers(table, row, "v", "rgb", {0, 1}));
    }
  }
  return rows;
}

absl::StatusOr<std::vector<SceneRow>> ReadSceneRows(const std::filesystem::path& file,
                                                    RowMaterial material) {
  EYEBOX_ASSIGN_OR_RETURN(const CsvTable table, ReadCsv(file));
  return SceneRowsOf(table, material);
}

}  // namespace eyebox::fit
