// index.csv of frames that other software took: one row a frame.
#ifndef EYEBOX_CAPTURE_RECORDING_IMPORT_INDEX_H_
#define EYEBOX_CAPTURE_RECORDING_IMPORT_INDEX_H_

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "capture/base/capture_spec.h"

namespace eyebox::capture {

struct IndexedFrame {
  std::filesystem::path file;  // joined to the folder
  std::string where;           // "index.csv:3": how a message about the row begins
  CaptureSpec spec;            // of this frame alone: repeats is 1
  long repeat = 0;
  std::optional<int> bits;
  std::optional<int64_t> device_time_ns;
  std::optional<double> photodiode_counts;
};

// Columns file,kind,exposure_s,gain_db,series,repeat; where known also
// pattern,diameter_deg,drive_r,drive_g,drive_b,luminance_cd_m2,luminance_relative_sigma,timestamp_s,
// photodiode_counts,bits. Any order; an empty field of the second group is unknown.
// Errors: NotFound (no index.csv, a file that it names), InvalidArgument (file, line, column).
absl::StatusOr<std::vector<IndexedFrame>> ReadImportIndex(const std::filesystem::path& folder);

}  // namespace eyebox::capture

#endif  // EYEBOX_CAPTURE_RECORDING_IMPORT_INDEX_H_
