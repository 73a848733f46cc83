// Frames for other software: the counterpart of import.
#ifndef EYEBOX_CAPTURE_RECORDING_EXPORT_H_
#define EYEBOX_CAPTURE_RECORDING_EXPORT_H_

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "absl/status/statusor.h"
#include "capture/base/capture_spec.h"

namespace eyebox::capture {

struct ExportFilter {
  std::optional<FrameKind> kind;
  std::optional<std::string> series;
};

struct ExportReport {
  int captures = 0;
  int64_t frames = 0;
};

// Called after every capture.
using ExportProgress = std::function<void(int captures_done, int captures_total)>;

// Writes every verified frame as a 16-bit TIFF, `folder`/000001-00001.tiff being the first of the
// first capture, and an index.csv that ImportFolder reads: it gives back the same counts, settings
// and stimuli. Captures of one specification come back as one. timestamp_s is the time of
// reception, or the device's where there is none. `folder` appears whole or not at all.
// Errors: those of RecordingReader; NotFound (the filter leaves nothing: lists what there is),
// InvalidArgument (a line break in the name of a series), AlreadyExists, the errno of the disk.
absl::StatusOr<ExportReport> ExportTiff(const std::filesystem::path& recording,
                                        const std::filesystem::path& folder,
                                        const ExportFilter& filter = {},
                                        const ExportProgress& progress = nullptr);

}  // namespace eyebox::capture

#endif  // EYEBOX_CAPTURE_RECORDING_EXPORT_H_
