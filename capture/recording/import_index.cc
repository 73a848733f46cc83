#include "capture/recording/import_index.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <system_error>
#include <utility>

#include "capture/base/csv.h"
#include "capture/base/status.h"

namespace eyebox::capture {
namespace {

constexpr std::array<std::string_view, 6> kRequired = {"file",    "kind",   "exposure_s",
                                                       "gain_db", "series", "repeat"};
constexpr std::array<std::string_view, 10> kOptional = {"pattern",
                                                        "diameter_deg",
                                                        "drive_r",
                                                        "drive_g",
                                                        "drive_b",
                                                        "luminance_cd_m2",
                                                        "luminance_relative_sigma",
                                                        "timestamp_s",
                                                        "photodiode_counts",
                                                        "bits"};
constexpr double kLatestS = 9e9;  // in nanoseconds it still fits 64 bits

absl::Status CheckColumns(const CsvTable& table) {
  for (const std::string_view name : kRequired) {
    EYEBOX_RETURN_IF_ERROR(table.Column(name).status());
  }
  for (const std::string_view name : table.Header()) {
    if (std::ranges::find(kRequired, name) == kRequired.end() &&
        std::ranges::find(kOptional, name) == kOptional.end()) {
      return BadInput(table.File().string() + ":1",
                      "has a column '" + std::string(name) + "' that is not known",
                      "remove it or mend its name; proto/README.md lists the columns");
    }
  }
  return absl::OkStatus();
}

// One row, its fields by name.
class Row {
 public:
  Row(const CsvTable& table, size_t row) : table_(table), row_(row) {}

  std::string Where(std::string_view name) const {
    return table_.Where(row_, *table_.FindColumn(name));
  }

  // Empty also where there is no such column.
  std::string_view Text(std::string_view name) const {
    const auto column = table_.FindColumn(name);
    return column ? table_.Field(row_, *column) : std::string_view();
  }

  absl::StatusOr<double> Number(std::string_view name, double minimum, double maximum) const {
    EYEBOX_ASSIGN_OR_RETURN(const double value, table_.Number(row_, *table_.FindColumn(name)));
    if (value >= minimum && value <= maximum) return value;
    return BadInput(Where(name), "is " + std::string(Text(name)),
                    "give " + std::to_string(minimum) + " to " + std::to_string(maximum));
  }

  absl::StatusOr<std::optional<double>> Known(std::string_view name, double minimum,
                                              double maximum) const {
    if (Text(name).empty()) return std::nullopt;
    return Number(name, minimum, maximum);
  }

  absl::StatusOr<long> WholeNumber(std::string_view name) const {
    return table_.WholeNumber(row_, *table_.FindColumn(name));
  }

  template <typename T>
  absl::StatusOr<T> OneOf(std::string_view name,
                          std::initializer_list<std::pair<std::string_view, T>> values) const {
    std::string known;
    for (const auto& [text, value] : values) {
      if (Text(name) == text) return value;
      known += (known.empty() ? "" : ", ") + std::string(text);
    }
    return BadInput(Where(name), "is '" + std::string(Text(name)) + "'", "give one of " + known);
  }

 private:
  const CsvTable& table_;
  const size_t row_;
};

absl::StatusOr<Stimulus> ReadStimulus(const Row& row) {
  Stimulus stimulus;
  if (!row.Text("pattern").empty()) {
    EYEBOX_ASSIGN_OR_RETURN(
        stimulus.pattern,
        row.OneOf<StimulusPattern>("pattern", {{"full_field", StimulusPattern::kFullField},
                                               {"disk", StimulusPattern::kDisk},
                                               {"black_disk", StimulusPattern::kBlackDisk},
                                               {"checkerboard", StimulusPattern::kCheckerboard}}));
  }
  EYEBOX_ASSIGN_OR_RETURN(const auto diameter_deg, row.Known("diameter_deg", 0, 180));
  stimulus.diameter_deg = diameter_deg.value_or(0);
  const bool full_field = stimulus.pattern == StimulusPattern::kFullField;
  if (full_field != (stimulus.diameter_deg == 0)) {
    return BadInput(
        row.Where(full_field ? "diameter_deg" : "pattern"),
        full_field ? "belongs to a disk or a checkerboard" : "has no diameter_deg above 0",
        "give every disk its diameter, every checkerboard the side of a square, and "
        "nothing to full fields");
  }
  constexpr std::array<std::string_view, 3> kDrives = {"drive_r", "drive_g", "drive_b"};
  const auto known =
      std::ranges::count_if(kDrives, [&row](auto name) { return !row.Text(name).empty(); });
  if (known == 0) return stimulus;
  DriveRgb drive{};
  for (size_t i = 0; i < drive.size(); ++i) {
    if (row.Text(kDrives[i]).empty()) {
      const auto given =
          std::ranges::find_if(kDrives, [&row](auto name) { return !row.Text(name).empty(); });
      return BadInput(row.Where(*given), "is given without " + std::string(kDrives[i]),
                      "give all of drive_r, drive_g and drive_b, or none");
    }
    EYEBOX_ASSIGN_OR_RETURN(drive[i], row.Number(kDrives[i], 0, 1));
  }
  stimulus.drive = drive;
  return stimulus;
}

absl::StatusOr<CaptureSpec> ReadSpec(const Row& row) {
  CaptureSpec spec;
  EYEBOX_ASSIGN_OR_RETURN(spec.kind, row.OneOf<FrameKind>("kind", {{"light", FrameKind::kLight},
                                                                   {"dark", FrameKind::kDark},
                                                                   {"flat", FrameKind::kFlat}}));
  EYEBOX_ASSIGN_OR_RETURN(spec.exposure_s, row.Number("exposure_s", 1e-9, 1e6));
  EYEBOX_ASSIGN_OR_RETURN(spec.gain_db, row.Number("gain_db", -200, 200));
  spec.series = std::string(row.Text("series"));
  EYEBOX_ASSIGN_OR_RETURN(spec.stimulus, ReadStimulus(row));
  EYEBOX_ASSIGN_OR_RETURN(spec.luminance_cd_m2, row.Known("luminance_cd_m2", 0, 1e9));
  EYEBOX_ASSIGN_OR_RETURN(spec.luminance_relative_sigma,
                          row.Known("luminance_relative_sigma", 0, 1));
  if (spec.luminance_relative_sigma && !spec.luminance_cd_m2) {
    return BadInput(row.Where("luminance_relative_sigma"), "is given without a luminance",
                    "give luminance_cd_m2 too, or neither");
  }
  return spec;
}

absl::StatusOr<std::filesystem::path> ReadFileName(const Row& row,
                                                   const std::filesystem::path& folder) {
  const std::filesystem::path name(row.Text("file"));
  if (name.empty() || name.is_absolute()) {
    return BadInput(row.Where("file"), "is '" + name.string() + "'",
                    "name an image by its path below the folder of index.csv");
  }
  std::error_code error;
  if (std::filesystem::is_regular_file(folder / name, error)) return folder / name;
  return Missing(row.Where("file"), "names '" + name.string() + "', which does not exist",
                 "add the image or remove the row");
}

absl::StatusOr<IndexedFrame> ReadFrame(const CsvTable& table, size_t index,
                                       const std::filesystem::path& folder) {
  const Row row(table, index);
  IndexedFrame frame;
  frame.where = table.File().string() + ":" + std::to_string(table.LineOf(index));
  EYEBOX_ASSIGN_OR_RETURN(frame.file, ReadFileName(row, folder));
  EYEBOX_ASSIGN_OR_RETURN(frame.spec, ReadSpec(row));
  EYEBOX_ASSIGN_OR_RETURN(frame.repeat, row.WholeNumber("repeat"));
  EYEBOX_ASSIGN_OR_RETURN(frame.photodiode_counts, row.Known("photodiode_counts", -1e18, 1e18));
  EYEBOX_ASSIGN_OR_RETURN(const auto timestamp_s, row.Known("timestamp_s", -kLatestS, kLatestS));
  if (timestamp_s) frame.device_time_ns = std::llround(*timestamp_s * 1e9);
  if (!row.Text("bits").empty()) {
    EYEBOX_ASSIGN_OR_RETURN(const long bits, row.WholeNumber("bits"));
    if (bits < 1 || bits > 16) {
      return BadInput(row.Where("bits"), "is " + std::to_string(bits), "give 1 to 16");
    }
    frame.bits = static_cast<int>(bits);
  }
  return frame;
}

}  // namespace

absl::StatusOr<std::vector<IndexedFrame>> ReadImportIndex(const std::filesystem::path& folder) {
  EYEBOX_ASSIGN_OR_RETURN(const CsvTable table, ReadCsv(folder / "index.csv"));
  EYEBOX_RETURN_IF_ERROR(CheckColumns(table));
  std::vector<IndexedFrame> frames;
  for (size_t row = 0; row < table.RowCount(); ++row) {
    EYEBOX_ASSIGN_OR_RETURN(frames.emplace_back(), ReadFrame(table, row, folder));
  }
  return frames;
}

}  // namespace eyebox::capture
